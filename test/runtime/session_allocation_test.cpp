#include <limits>

#include <gtest/gtest.h>

#include "allocation_counter.hpp"
#include "control/clp/fixture.hpp"
#include "control/excitation/excitation.hpp"
#include "control/pi/pi.hpp"
#include "runtime/session.hpp"

namespace fpc {
namespace control_session_allocation_test {

PlantInfo plant() {
  PlantInfo info;
  info.header.time_ns = 1000000000;
  info.sample_time_s = 720.0;
  info.outputs = {{"s", "mg/l", 0, 1000}, {"x", "mg/l", 0, 5000}};
  info.inputs = {{"q_r", "m3/h", 0, 1600}};
  return info;
}

StepHeader header(std::uint32_t step) { return {1000000000 + step * 720000000000, 1, step}; }

// Sends the prediction it was given.
struct PredictiveStub final : Controller {
  void reset(const Measurement& /*start*/) override {}
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override {
    output.input = now.input_applied;
    output.source = ActionSource::kBase;
    output.reference = setpoint.present();
    output.predictive = true;
    output.prediction = prediction;
  }
  PredictiveAction prediction = clp_test::sludgeLike(8).now;
};

// Every kind of sample but the first: plain, repeated, old, not finite (held), manual.
void expectNoAllocations(std::unique_ptr<Controller> controller) {
  SetpointParams setpoints;
  setpoints.initial = Vector::Constant(2, 55.0);
  setpoints.schedule = {{1.0, Vector::Constant(2, 60.0)}, {2.0, Vector::Constant(2, 70.0)}};
  setpoints.rate_per_h = Vector::Constant(2, 5.0);
  const InputLimits limits = clp_test::sludgeLike(8).limits;
  ControllerSession session(std::move(controller), setpoints, limits, Vector::Constant(1, 570.0),
                            plant());
  Measurement m{header(0), Vector::Constant(2, 50.0), Vector(), Vector::Constant(1, 570.0), false};
  session.receive(m);
  std::uint64_t answered = 0;
  testing::AllocationCounter counter;
  for (std::uint32_t step = 1; step < 200; ++step) {
    if (step == 150) session.manual(true);
    m.header = header(step);
    m.outputs[0] = step == 149 ? std::numeric_limits<double>::quiet_NaN() : 50.0 + step;
    answered += session.receive(m) == Receipt::kAnswered ? 1 : 0;
    session.receive(m);
    m.header = header(step - 1);
    session.receive(m);
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(answered, 199u);
  EXPECT_EQ(session.counts().not_finite, 1u);
}

TEST(SessionAllocation, ControllerSessionDoesNotAllocatePerSample) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  PiParams params;
  params.loops.resize(1);
  params.loops[0].kp = 1.0;
  params.loops[0].ki_per_h = 0.1;
  expectNoAllocations(
      std::make_unique<PiController>(params, clp_test::sludgeLike(8).limits, plant()));
  expectNoAllocations(std::make_unique<PredictiveStub>());
  ExcitationParams excitation;
  excitation.signals.resize(1);
  excitation.signals[0].upper = 1000.0;
  for (const ExcitationKind signal : {ExcitationKind::kPrbs, ExcitationKind::kMultiLevel}) {
    excitation.signals[0].signal = signal;
    expectNoAllocations(std::make_unique<ExcitationController>(
        excitation, clp_test::sludgeLike(8).limits, Vector::Constant(1, 570.0), plant()));
  }
}

TEST(SessionAllocation, OptimizerSessionDoesNotAllocatePerSample) {
  if (!testing::AllocationCounter::works()) GTEST_SKIP() << "a sanitizer owns malloc";
  ClpParams params;
  params.perturbation_steps = 8;
  OptimizerSession session(params, clp_test::sludgeLike(8).limits, plant());
  PredictiveAction prediction = clp_test::sludgeLike(8).now;
  ControlAction base{header(0), Vector::Constant(1, 804.0), ActionSource::kBase};
  prediction.header = base.header;
  session.receive(base);
  ASSERT_TRUE(session.receive(prediction));
  testing::AllocationCounter counter;
  std::uint32_t solved = 0;
  for (std::uint32_t step = 1; step < 200; ++step) {
    base.header = prediction.header = header(step);
    base.source = step % 10 == 0 ? ActionSource::kHeld : ActionSource::kBase;
    prediction.feedforward.array() += 20.0;  // into the bound
    prediction.input_base_unclipped.array() += 20.0;
    session.receive(base);
    session.receive(prediction);
    solved += session.report().status == SolveStatus::kSolved ? 1 : 0;
  }
  const std::size_t allocations = counter.count();
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(solved, 199u - 19u);
}

}  // namespace control_session_allocation_test
}  // namespace fpc
