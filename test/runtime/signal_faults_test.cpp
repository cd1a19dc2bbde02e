// Sensors that repeat, freeze or round, beside a PI under the same fault: what the plant makes of
// it.
#include <cmath>
#include <functional>

#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_signal_faults_test {

using Fault = std::function<void(std::uint32_t, Measurement&)>;

/// Integral of the squared error of the first output, as the plant has it.
double ise(const std::string& name, const Overrides& overrides, const Fault& fault,
           std::uint32_t* frozen = nullptr) {
  const LoopFile loop = readLoop(name, overrides);
  Simulation plant = makeSimulation(loop);
  ControllerSession controller = makeControllerSession(loop);
  if (loop.has_model) controller.setModel(loop.model);
  plant.reset(1);
  controller.announce(1);
  double sum = 0.0;
  while (true) {
    Measurement m = plant.measurement();
    fault(m.header.step, m);
    controller.receive(m);
    if (frozen && controller.plausibility().doubt(0) == Doubt::kFrozen) ++*frozen;
    const double error = controller.answer().tracking.setpoint[0] - plant.state().outputs[0];
    sum += error * error;
    if (m.final) return sum;
    plant.advance(controller.answer().base.input);
  }
}

void none(std::uint32_t, Measurement&) {}

Fault everyTenthRepeated() {
  return [last = Vector()](std::uint32_t k, Measurement& m) mutable {
    if (k > 0 && k % 10 == 0) m.outputs = last;
    last = m.outputs;
  };
}

Fault frozen(std::uint32_t from, std::uint32_t to) {
  return [=, last = Vector()](std::uint32_t k, Measurement& m) mutable {
    if (k > from && k < to) m.outputs = last;
    last = m.outputs;
  };
}

/// The reactor of the PLC demo in one process.
Overrides reactor(const Overrides& more) {
  Overrides all{
      {"setpoint.initial.CA", "0.12"}, {"setpoint.schedule", "[{time_h: 0.3333333333, CA: 0.08}]"},
      {"sampling.duration_h", "1.2"},  {"actuator.move_upper.q_c", "4"},
      {"actuator.hold_samples", "5"},  {"actuator.fallback.q_c", "100"}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

const std::pair<std::string, std::string> kNoise{"noise.std.CA", "0.0002"};
const std::pair<std::string, std::string> kBlind{"plausibility.signals.CA.frozen", "false"};
const Overrides kHeld{{"setpoint.schedule", "[]"}};

TEST(SignalFaults, ALevelInStepsBringsAnObserver) {
  const Overrides coarse{{"sensors.step_s", "0.1"}, {"sensors.H.resolution", "0.00075"}};
  const double ours = ise("surge_tank_steps", coarse, none);
  const double pi = ise("surge_tank_steps_pi", coarse, none);
  EXPECT_LT(ours, 0.9 * pi) << ours << " " << pi;
}

TEST(SignalFaults, AReadingThatComesTwiceCostsLittle) {
  const double ours = ise("surge_tank_steps", {}, everyTenthRepeated());
  const double pi = ise("surge_tank_steps_pi", {}, everyTenthRepeated());
  EXPECT_LT(ours, 1.1 * pi) << ours << " " << pi;
  const double held = ise("surge_tank_steps", kHeld, everyTenthRepeated());
  const double pi_held = ise("surge_tank_steps_pi", kHeld, everyTenthRepeated());
  EXPECT_LT(held, 1.1 * pi_held) << held << " " << pi_held;
}

// An analyser that freezes for half an hour of the reactor's time while the setpoint steps: it is
// found by its noise, and the model's value takes its place.
TEST(SignalFaults, AFrozenAnalyserIsFoundAndReplaced) {
  for (const std::uint32_t from : {190U, 203U, 240U, 260U}) {
    std::uint32_t found = 0;
    const double ours = ise("cstr_tracking", reactor({kNoise}), frozen(from, from + 300), &found);
    const double blind = ise("cstr_tracking", reactor({kNoise, kBlind}), frozen(from, from + 300));
    EXPECT_GT(found, 280U) << from;
    EXPECT_LT(ours, blind) << from << " " << ours << " " << blind;
  }
  std::uint32_t found = 0;
  ise("cstr_tracking", reactor({kNoise}), none, &found);
  EXPECT_EQ(found, 0U);
}

// Healthy instruments with noise, whose lines could be flat.
TEST(SignalFaults, NoSignalOfAHealthyNoisyLoopIsCalledFrozen) {
  for (const char* name : {"batch_fuzzy_eq44", "batch_linear_eq45"}) {
    const LoopFile loop =
        readLoop(name, {{"noise.std", "{T: 0.1, Tw: 0.1}"}, {"controller.preview", "false"}});
    SignalValidator validator(loop.plausibility, loop.plant_info);
    int judged = 0, frozen = 0;
    for (const SampleRecord& sample : runLoop(loop).samples) {
      validator.look(sample.measurement);
      for (std::size_t i = 0; i < loop.plausibility.outputs.size(); ++i, ++judged)
        frozen += validator.doubt(i) == Doubt::kFrozen ? 1 : 0;
    }
    EXPECT_GT(judged, 100) << name;
    EXPECT_EQ(frozen, 0) << name;
  }
}

}  // namespace loop_signal_faults_test
}  // namespace fpc
