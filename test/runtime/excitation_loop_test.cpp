// Loop files with an open-loop experiment: keys, mistakes, and what a run of one leaves behind.
#include <gtest/gtest.h>

#include <cmath>

#include "base/csv.hpp"
#include "config/disturbance_source.hpp"
#include "control/excitation/excitation.hpp"
#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_excitation_loop_test {

std::string experiment(const std::string& signal) {
  return "plant:\n  type: activated_sludge\nsampling:\n  sample_time_s: 720\n  duration_h: 20\n"
         "seed: 3\ncontroller:\n  type: excitation\n  signals:\n    - {input: q_r, " +
         signal + "}\n";
}

class ExcitationLoop : public LoopFolder {
 protected:
  std::string errorWith(const std::string& signal) const {
    const std::string file = write("loop.yaml", experiment(signal));
    return errorOf([&] { readLoop(file); });
  }
};

TEST_F(ExcitationLoop, TimesInSecondsBecomeSamples) {
  const auto read = [&](const std::string& signal) {
    return readLoop(write("loop.yaml", experiment(signal)));
  };
  const LoopFile loop = read("signal: multi_level, hold_s: [7200, 43200]");
  const ExcitationSignal& levels = loop.controllerParams<ExcitationParams>().signals.at(0);
  EXPECT_EQ(loop.controllerParams<ExcitationParams>().seed, 3U);
  EXPECT_EQ(levels.hold_lower_steps, 10);
  EXPECT_EQ(levels.hold_upper_steps, 60);
  EXPECT_EQ(levels.lower, loop.simulation.actuator.limits.lower[0]);
  EXPECT_EQ(levels.upper, loop.simulation.actuator.limits.upper[0]);
  const LoopFile prbs = read("signal: prbs, clock_s: 1440");
  EXPECT_EQ(prbs.controllerParams<ExcitationParams>().signals.at(0).clock_steps, 2);
  const LoopFile steps = read("signal: steps, schedule: [{time_h: 0.2, value: 5}]");
  EXPECT_EQ(steps.controllerParams<ExcitationParams>().signals.at(0).schedule.at(0).step, 1);
  EXPECT_EQ(steps.exchange.wait_for,
            (std::vector<std::string>{"loop_recorder", "fmbpc_controller"}));
}

TEST_F(ExcitationLoop, MistakesNameFileLineKeyAndWhatIsExpected) {
  const std::string holds = "signal: multi_level, hold_s: [720, 1440], ";
  expectWords(errorWith("signal: prbs, clock_s: 700"),
              {"loop.yaml:10: controller.signals[0].clock_s", "whole number of samples of 720 s"});
  expectWords(errorWith("signal: prbs, clock_s: 0"), {"signals[0].clock_s", "at least 1"});
  expectWords(errorWith("signal: prbs, range: [0, 1e6]"), {"signals[0].range"});
  expectWords(errorWith("signal: prbs, range: [20, 10]"), {"range", "[lower, upper]"});
  expectWords(errorWith("signal: prbs, hold_s: [720, 2160]"), {"hold_s: unknown key"});
  expectWords(errorWith("signal: none}\n  feedback:\n    - {input: q_r, output: y, gain: 1"),
              {"feedback[0].output"});
  expectWords(errorWith("signal: none}\n  feedback:\n    - {input: q_r, output: s"),
              {"feedback[0].gain"});
  expectWords(errorWith("signal: sine"), {"signals[0].signal", "prbs, multi_level, steps, none"});
  expectWords(errorWith("signal: multi_level"), {"signals[0].hold_s"});
  expectWords(errorWith("signal: multi_level, hold_s: [720, 0]"), {"signals[0].hold_s"});
  expectWords(errorWith("signal: multi_level, hold_s: [3600, 2880]"),
              {"hold_s", "[shortest, longest]"});
  expectWords(errorWith(holds + "levels: [1, -1]"), {"levels", "limits"});
  expectWords(errorWith(holds + "levels: [1], range: [0, 1]"), {"either levels"});
  expectWords(errorWith("signal: steps"), {"signals[0].schedule", "a list"});
  expectWords(errorWith("signal: steps, schedule: [{time_h: 0.3, value: 5}]"),
              {"schedule[0].time_h", "whole number of samples"});
  expectWords(errorWith("signal: steps, schedule: [{time_h: 1, value: 5}, {time_h: 1, value: 6}]"),
              {"schedule[1].time_h", "increase"});
  expectWords(errorWith("signal: none}\n    - {input: q_r, signal: none"),
              {"signals[1].input", "no other signal"});
}

TEST_F(ExcitationLoop, WithoutSetpointsTheIndicesAreAbsentInEveryReport) {
  const LoopFile loop =
      readLoop(write("loop.yaml", experiment("signal: multi_level, range: [200, 900], "
                                             "hold_s: [2160, 5760]")));
  const RunRecord record = runLoop(loop);
  const Summary summary = summarize(loop, record, 0.0);
  EXPECT_TRUE(summary.complete);
  EXPECT_EQ(summary.steps, 100U);
  EXPECT_EQ(summary.input_violations + summary.move_violations, 0U);
  for (const OutputIndices& y : summary.outputs) EXPECT_TRUE(std::isnan(y.ise));
  writeRun(loop, record, summary, folder_.string());
  const Summary back = readSummary(path("summary.json"));
  for (const OutputIndices& y : back.outputs) EXPECT_TRUE(std::isnan(y.rmse));
  EXPECT_EQ(toTable({back}).find("nan"), std::string::npos);
  const CsvTable table = readCsv(path("trajectory.csv"));
  EXPECT_EQ(table.missing(table.column("x_setpoint")), 101);
  EXPECT_EQ(table.missing(table.column("x")), 0);
  EXPECT_EQ(table.missing(table.column("q_r")), 1) << "that of the last sample";
}

TEST_F(ExcitationLoop, TheValidationRecordHasOtherLoadsAndOtherLevels) {
  const LoopFile first = readLoop("asp_excite"), second = readLoop("asp_excite_validation");
  EXPECT_EQ(first.simulation.samples, 3320U);
  EXPECT_EQ(second.simulation.samples, 1660U);
  EXPECT_NE(first.controllerParams<ExcitationParams>().seed,
            second.controllerParams<ExcitationParams>().seed);
  EXPECT_NE(first.disturbance.pattern.seed, second.disturbance.pattern.seed);
  EXPECT_NEAR(makeDisturbance(first).values.row(1).mean(), 366.67, 1e-9);
}

}  // namespace loop_excitation_loop_test
}  // namespace fpc
