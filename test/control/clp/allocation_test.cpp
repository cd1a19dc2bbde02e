// The step of the closed-loop paradigm does not allocate after the first call, whatever it decides.
// The allocation counter replaces malloc: this file is a test program of its own.
#include "allocation_counter.hpp"
#include "control/clp/fixture.hpp"

#include <gtest/gtest.h>

namespace fpc::clp_test {
namespace control_clp_allocation_test {

using testing::AllocationCounter;

// Twenty samples in closed loop around hard limits, counted from the second one.
void countSteps(const ClpParams& params, bool moves) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  Case made = sludgeLike(params.perturbation_steps);
  PredictiveAction& now = made.now;
  made.limits.upper[0] = 700.0;
  if (moves) made.limits.move[0] = 25.0;
  ClosedLoopParadigm clp = made.make(params);
  ControlAction action;
  SolverReport report;
  clp.step(now, action, report);
  std::size_t allocations = 0;
  int active = 0;
  for (int k = 0; k < 20; ++k) {
    now.state = now.A * now.state + now.B * action.input + now.offset_state;
    now.feedforward.setConstant(k % 2 == 0 ? 8800.0 : 8400.0);
    now.setpoint[1] = k % 2 == 0 ? 2100.0 : 1900.0;  // the aim of lq
    now.input_base_unclipped = baseLaw(now);
    now.input_previous = action.input;
    const AllocationCounter counter;
    clp.step(now, action, report);
    allocations += counter.count();
    active += report.active_rows > 0;
    ASSERT_EQ(report.status, SolveStatus::kSolved) << k;
    ASSERT_LE(report.kkt_residual, 1e-9) << k;
  }
  EXPECT_EQ(allocations, 0u);
  EXPECT_GT(active, 0);
}

TEST(ClpAllocation, NoneWithBounds) { countSteps(steps(42), false); }

TEST(ClpAllocation, NoneWithBoundsAndMoves) { countSteps(steps(42), true); }

TEST(ClpAllocation, NoneOnALongHorizon) { countSteps(steps(200), false); }

TEST(ClpAllocation, NoneWithSoftOutputsAndTracking) {
  ClpParams params = steps(42);
  params.output_upper = (Vector(2) << kInfinity, 1990.0).finished();
  params.output_lower = (Vector(2) << 20.0, 1500.0).finished();
  params.weight_tracking = (Vector(2) << 0.0, 0.1).finished();
  countSteps(params, true);
}

TEST(ClpAllocation, NoneWithLqAndIncrementalBounds) {
  ClpParams params = steps(42);
  params.cost = ClpCostKind::kLq;
  params.target_outputs = {1};
  countSteps(params, true);
  params.bounds = ClpBounds::kIncremental;
  params.increment_lower = Vector::Constant(1, -20.0);
  params.increment_upper = Vector::Constant(1, 20.0);
  countSteps(params, false);
}

TEST(ClpAllocation, NoneWhenTheStepFails) {
  if (!AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  Case made = sludgeLike(42);
  made.limits.upper[0] = 500.0;
  ClpParams params = steps(42);
  params.qp.max_iterations = 1;
  ClosedLoopParadigm clp = made.make(params);
  ControlAction action;
  SolverReport report;
  clp.step(made.now, action, report);
  ASSERT_EQ(report.status, SolveStatus::kIterationLimit);
  const AllocationCounter counter;
  clp.step(made.now, action, report);
  made.now.input_base_unclipped[0] += 1.0;
  clp.step(made.now, action, report);
  made.now.state[0] = std::nan("");
  clp.step(made.now, action, report);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_EQ(report.status, SolveStatus::kInvalidProblem);
}

}  // namespace control_clp_allocation_test
}  // namespace fpc::clp_test
