// A recorded run through controller and optimizer again: the same bits, or the first difference.
#include "runtime/replay.hpp"

#include <gtest/gtest.h>

#include "config/command_file.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_replay_test {

class ReplayOfRuns : public LoopFolder {
 protected:
  /// A run with a setpoint at sample 25, manual from 50 on with 650 from 60 on, auto from 80 on.
  RecordedRun record(const LoopFile& loop) {
    RunOptions options;
    options.commands = readCommands(write("commands.yaml",
                                          "commands:\n"
                                          "- {time_h: 5, setpoint: {x: 1900}}\n"
                                          "- {time_h: 10, manual: true}\n"
                                          "- {time_h: 12, manual_input: {q_r: 650}}\n"
                                          "- {time_h: 16, manual: false}\n"),
                                    loop);
    RecordedRun run;
    for (const SampleRecord& sample : runLoop(loop, options).samples) {
      const std::uint32_t step = sample.measurement.header.step;
      run.measurements[step] = sample.measurement;
      if (sample.measurement.final) continue;
      if (loop.has_clp) run.base[step] = sample.base;
      run.control.emplace(step, sample.action);
    }
    run.setpoints.emplace(25, Command{0, {"x"}, {1900.0}, CommandMode::kOverride});
    OperatorState operator_state;
    operator_state.manual = true;
    run.operator_state.emplace(50, operator_state);
    operator_state.manual_given = true;
    operator_state.manual_input = Vector::Constant(1, 650.0);
    run.operator_state.emplace(60, operator_state);
    run.operator_state.emplace(80, OperatorState{});
    IdentifierSession identifier(loop);
    if (const TsModel* model = identifier.start()) run.models.emplace(0, *model);
    return run;
  }
  static LoopFile loop(const std::string& name) {
    return readLoop(name, {{"sampling.duration_h", "40"}, {"noise.std.x", "5"}});
  }
};

TEST_F(ReplayOfRuns, ActionsAreTheSameBitForBit) {
  for (const char* name : {"asp_case1", "asp_case1_clp", "asp_case1_pi_x"}) {
    const RecordedRun run = record(loop(name));
    const ReplayResult result = replay(loop(name), run);
    EXPECT_EQ(result.measurements, 201U) << name;
    EXPECT_EQ(result.control.compared, 200U) << name;
    EXPECT_EQ(result.control.equal, 200U) << name << " " << result.control.first_difference;
    EXPECT_EQ(result.base.equal, result.base.compared) << name << result.base.first_difference;
    EXPECT_TRUE(result.equal()) << name;
    EXPECT_TRUE(result.refused.empty()) << name;
  }
}

TEST_F(ReplayOfRuns, TheFirstDifferenceIsNamed) {
  RecordedRun run = record(loop("asp_case1_clp"));
  run.measurements[30].outputs[1] += 1.0;
  const ReplayResult result = replay(loop("asp_case1_clp"), run);
  EXPECT_FALSE(result.equal());
  EXPECT_LT(result.base.equal, 200U);
  EXPECT_EQ(result.base.first_difference.find("sample 30: recorded ["), 0U)
      << result.base.first_difference;
}

TEST_F(ReplayOfRuns, WhatAnOperatorAskedBelongsToTheRun) {
  RecordedRun run = record(loop("asp_case1"));
  run.operator_state.clear();
  EXPECT_EQ(replay(loop("asp_case1"), run).control.first_difference.find("sample 50"), 0U);
  run.setpoints.clear();
  EXPECT_EQ(replay(loop("asp_case1"), run).control.first_difference.find("sample 25"), 0U);
}

TEST_F(ReplayOfRuns, ABaseActionInPlaceOfTheOptimizersIsCounted) {
  RecordedRun run = record(loop("asp_case1_clp"));
  for (std::uint32_t step = 10; step < 20; ++step) {
    run.control.erase(step);
    run.control.emplace(step, run.base[step]);
  }
  const ReplayResult result = replay(loop("asp_case1_clp"), run);
  EXPECT_TRUE(result.equal()) << result.control.first_difference;
  EXPECT_EQ(result.stood_in + (result.control.compared - 190U), 10U);
}

TEST_F(ReplayOfRuns, WhatIsMissingIsNamedBeforeAnythingIsCompared) {
  RecordedRun run = record(loop("asp_case1_clp"));
  run.base.erase(20);
  for (const std::uint32_t step : {30U, 31U, 32U}) run.measurements.erase(step);
  run.control.erase(31);
  const ReplayResult result = replay(loop("asp_case1_clp"), run);
  EXPECT_EQ(result.missing,
            (std::vector<std::string>{"sample 20: no base_action", "sample 30: no measurement",
                                      "sample 31: no measurement, control_action",
                                      "sample 32: no measurement"}));
  EXPECT_EQ(result.missing_samples, 4U);
  EXPECT_EQ(result.measurements, 30U);  // what came after them is not blamed on the controller
  EXPECT_EQ(result.control.compared, 30U);
  EXPECT_EQ(result.control.equal, 30U) << result.control.first_difference;
  EXPECT_EQ(result.base.compared, 29U);
  EXPECT_FALSE(result.equal());
}

TEST_F(ReplayOfRuns, ARecordThatEndsEarlyIsWholeSoFar) {
  RecordedRun run = record(loop("asp_case1"));
  EXPECT_TRUE(replay(loop("asp_case1"), run).ended);
  run.measurements.erase(run.measurements.find(90), run.measurements.end());
  run.control.erase(run.control.find(89), run.control.end());
  const ReplayResult result = replay(loop("asp_case1"), run);
  EXPECT_FALSE(result.ended);
  EXPECT_TRUE(result.equal()) << result.control.first_difference;
  run.measurements.erase(0);  // one that began late knows nothing of the law's past
  EXPECT_EQ(replay(loop("asp_case1"), run).missing.at(0), "sample 0: no measurement");
  EXPECT_EQ(replay(loop("asp_case1"), run).control.compared, 0U);
}

TEST_F(ReplayOfRuns, ARecordWithoutItsModelIsRefused) {
  RecordedRun run = record(loop("asp_case1"));
  run.models.clear();
  expectWords(errorOf([&] { replay(loop("asp_case1"), run); }), {"model", "fuzzy_model"});
  EXPECT_FALSE(ReplayResult{}.equal());  // nothing compared is not equal
}

}  // namespace loop_replay_test
}  // namespace fpc
