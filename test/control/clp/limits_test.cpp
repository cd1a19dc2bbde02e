// Limits of the closed-loop paradigm: bounds and moves hard, outputs soft, increments as
// in the paper.
#include "control/clp/fixture.hpp"

#include <gtest/gtest.h>

namespace fpc::clp_test {
namespace control_clp_limits_test {

TEST(ClpLimits, MoveLimitHoldsFromThePreviousInputOn) {
  Case made = eager(6);
  made.limits.move = one(4.0);
  ClosedLoopParadigm clp = made.make(steps(6));
  Outcome out;
  clp.step(made.now, out.action, out.report);
  EXPECT_EQ(out.input(), 4.0);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  const Matrix planned = plannedInputs(clp, 6);
  for (int i = 1; i < 6; ++i) EXPECT_LE(std::abs(planned(i) - planned(i - 1)), 4.0 + 1e-8);
}

TEST(ClpLimits, BoundWinsOverMoveLimitAndSaysSo) {
  for (const double previous : {-40.0, 90.0}) {
    Case made = eager(5);
    made.limits = {one(0.0), one(20.0), one(3.0)};
    made.now.input_previous = one(previous);
    const Outcome out = decide(made, steps(5));
    EXPECT_EQ(out.input(), previous < 0.0 ? 0.0 : 20.0);
    EXPECT_EQ(out.report.status, SolveStatus::kBoundWins);
  }
}

TEST(ClpLimits, AReachableBoundIsNoConflict) {
  Case made = eager(5);
  made.limits = {one(0.0), one(20.0), one(3.0)};
  made.now.input_previous = one(-2.0);
  const Outcome out = decide(made, steps(5));
  EXPECT_EQ(out.input(), 1.0);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
}

TEST(ClpLimits, AnInputFixedByEqualBoundsStaysThere) {
  Case made = eager(5);
  made.limits.lower = made.limits.upper = one(7.25);
  const Outcome out = decide(made, steps(5));
  EXPECT_EQ(out.input(), 7.25);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
}

TEST(ClpLimits, LqKeepsItsBounds) {
  Case made = sludgeLike(42);
  made.limits.upper = one(700.0);
  made.now.setpoint[1] = 2150.0;
  ClpParams params = steps(42);
  params.cost = ClpCostKind::kLq;
  params.target_outputs = {1};
  const Outcome out = decide(made, params);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  EXPECT_EQ(out.input(), 700.0);
  EXPECT_LE(out.report.kkt_residual, 1e-9);
}

TEST(ClpLimits, TheIncrementalBoundIsKeptWhereverTheLawAims) {
  Case made = sludgeLike(42);
  made.now.feedforward.array() += 500.0;  // the law aims elsewhere than the steady state
  made.now.input_base_unclipped = baseLaw(made.now);
  ClpParams params = steps(42);
  params.cost = ClpCostKind::kLq;
  params.bounds = ClpBounds::kIncremental;
  params.target_outputs = {1};
  params.increment_lower = one(-100.0);
  params.increment_upper = one(100.0);
  ClosedLoopParadigm clp = made.make(params);
  Outcome out;
  clp.step(made.now, out.action, out.report);
  const double u_ss = clp.steadyInput()[0];
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  EXPECT_LE(std::abs(out.input() - u_ss), 100.0 + 1e-9);
}

TEST(ClpLimits, IncrementalBoundsNeverOutbidTheActuator) {
  Case made = sludgeLike(10);
  made.limits = {one(0.0), one(300.0), one(30.0)};
  made.now.input_previous = one(280.0);
  ClpParams params = steps(10);
  params.bounds = ClpBounds::kIncremental;
  params.target_outputs = {1};
  params.increment_lower = one(-200.0);
  params.increment_upper = one(200.0);
  const Outcome out = decide(made, params);
  EXPECT_EQ(out.input(), 300.0);
  EXPECT_EQ(out.action.source, ActionSource::kClipped);
}

TEST(ClpLimits, AnAvoidableOutputViolationIsAvoided) {
  Case made = eager(15);
  made.now.feedforward.setConstant(40.0);  // settles above 6
  made.now.input_base_unclipped = baseLaw(made.now);
  ClpParams params = steps(15);
  const auto highest = [&](const ClosedLoopParadigm& clp) {
    const Matrix u = plannedInputs(clp, 15);
    return roll(made.now, 15, [&](int i, const Vector&) -> Vector { return u.col(i); }).maxCoeff();
  };
  Outcome out;
  ClosedLoopParadigm free = made.make(params);
  free.step(made.now, out.action, out.report);
  EXPECT_EQ(out.action.source, ActionSource::kBase);
  const double without = highest(free);
  EXPECT_GT(without, 5.5);
  params.output_upper = one(5.0);
  ClosedLoopParadigm soft = made.make(params);
  soft.step(made.now, out.action, out.report);
  EXPECT_EQ(out.report.status, SolveStatus::kSolved);
  EXPECT_LE(out.report.kkt_residual, 1e-9);
  EXPECT_LE(highest(soft) - 5.0, 1e-3 * (without - 5.0));
}

TEST(ClpLimits, AnUnavoidableOutputViolationIsLeastAndInputLimitsHold) {
  Case made = firstOrderLag(0.9, 0.1, 0.0, 0.0, 15, 10.0);
  made.limits = {one(-10.0), one(10.0), one(kInfinity)};
  ClpParams params = steps(15);
  params.output_upper = one(5.0);
  ClosedLoopParadigm clp = made.make(params);
  Outcome out;
  clp.step(made.now, out.action, out.report);
  EXPECT_EQ(out.input(), -10.0);
  const double violation = clp.solution().x[15] * clp.problem().slack_scale[0];
  EXPECT_NEAR(violation, 0.9 * 10.0 - 0.1 * 10.0 - 5.0, 3e-3);  // y(1) cannot be below 8
  EXPECT_LE(clp.solution().x.head(15).cwiseAbs().maxCoeff() * clp.problem().input_scale[0], 10.0);
}

TEST(ClpLimits, AViolationInsideTheDeadTimeExcusesNoLaterOne) {
  // y(k+1) = 0.9 y + 0.1 u(k-2), from 10: 9 and 8.1 cannot be helped, what follows can
  Case made = firstOrderLag(0.9, 0.1, 0.0, 0.0, 10, 0.0);
  PredictiveAction& now = made.now;
  now.A = (Matrix(3, 3) << 0.9, 0.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0).finished();
  now.B = Matrix::Identity(3, 3).col(2);
  now.C = Matrix::Identity(1, 3);
  now.state = (Vector(3) << 10.0, 0.0, 0.0).finished();
  now.offset_state = Vector::Zero(3);
  now.K = Matrix::Zero(1, 3);
  now.input_base_unclipped = baseLaw(now);
  made.limits = {one(-100.0), one(100.0), one(kInfinity)};
  ClpParams params = steps(10);
  params.output_upper = one(5.0);
  ClosedLoopParadigm clp = made.make(params);
  Outcome out;
  clp.step(now, out.action, out.report);
  EXPECT_NEAR(out.input(), (5.0 - 7.29) / 0.1, 0.1);  // y(3) = 0.729 10 + 0.1 u(0) = 5
}

}  // namespace control_clp_limits_test
}  // namespace fpc::clp_test
