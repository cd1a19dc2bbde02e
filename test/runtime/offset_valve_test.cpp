// Valves with an offset, or stuck: commands keep the move limit from one to the next, the loop does
// not run away, and the summary says what a person must know.
#include <cmath>

#include "events.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_offset_valve_test {

LoopFile with(const std::string& name, const std::string& input, double time_h, double value,
              const std::string& mode) {
  return readLoop(name, {{"disturbance.commands",
                          "[{time_h: " + exactText(time_h) + ", name: input/" + input +
                              ", value: " + exactText(value) + ", mode: " + mode + "}]"}});
}

/// The largest move from one command to the next, in shares of its limit.
double largestMove(const LoopFile& loop, const RunRecord& record) {
  const Vector& limit = loop.simulation.actuator.limits.move;
  double largest = 0.0;
  for (std::size_t k = 1; k < record.samples.size(); ++k)
    if (record.samples[k].has_action && record.samples[k - 1].has_action)
      largest =
          std::max(largest, (record.samples[k].action.input - record.samples[k - 1].action.input)
                                .cwiseAbs()
                                .cwiseQuotient(limit)
                                .maxCoeff());
  return largest;
}

TEST(OffsetValve, CommandsKeepTheMoveLimitAndTheSetpointIsKept) {
  for (const double offset : {-5.0, 0.5, 1.9, 2.0, 2.5, 5.0}) {
    const LoopFile loop = with("heated_tank", "heat", 0.5, offset, "offset");
    const RunRecord record = runLoop(loop);
    const Summary summary = summarize(loop, record, 0.0);
    EXPECT_LE(largestMove(loop, record), 1.0 + 1e-8) << offset;
    EXPECT_EQ(summary.move_violations, 0U) << offset;
    EXPECT_FALSE(contains(summary.events, EventCode::kInputAtLimit)) << offset;
    const SampleRecord& last = record.samples.back();
    EXPECT_NEAR(last.state.outputs[0], last.tracking.setpoint[0], 1.0) << offset;
    const Event* told = test::find(summary.events, EventCode::kInputStuck, "heat");
    EXPECT_EQ(told != nullptr, std::abs(offset) > 0.4 + 1e-9) << offset;
  }
}

TEST(OffsetValve, PlansOfThePredictiveLawsKeepItAsWell) {
  for (const char* name : {"methanol_clip", "methanol_clp"})
    for (const double offset : {-0.3, 0.1, 0.5}) {
      const LoopFile loop = with(name, "R", 0.5, offset, "offset");
      const RunRecord record = runLoop(loop);
      const Summary summary = summarize(loop, record, 0.0);
      EXPECT_LE(largestMove(loop, record), 1.0 + 1e-8) << name << offset;
      EXPECT_EQ(summary.move_violations, 0U) << name << offset;
      const Event* locked = test::find(summary.events, EventCode::kInputAtLimit, "R");
      EXPECT_FALSE(offset > 0.0 && locked && locked->text.find("upper") != std::string::npos)
          << name << offset << ": an offset upwards asks for less";
    }
}

TEST(OffsetValve, AStuckValveIsInTheSummaryAndNothingWindsUpAgainstIt) {
  const LoopFile loop = with("heated_tank", "heat", 0.2, 5.0, "override");
  const RunRecord record = runLoop(loop);
  const Summary summary = summarize(loop, record, 0.0);
  const Event* told = test::find(summary.events, EventCode::kInputStuck, "heat");
  ASSERT_NE(told, nullptr);
  EXPECT_GT(told->count, 100U);
  EXPECT_GT(told->first, 24U);  // 0.2 h
  EXPECT_LE(largestMove(loop, record), 1.0 + 1e-8);
  EXPECT_LE(record.samples[record.samples.size() - 2].action.input[0], 7.0 + 1e-9);
  const LoopFile plain = readLoop("heated_tank");
  EXPECT_FALSE(contains(summarize(plain, runLoop(plain), 0.0).events, EventCode::kInputStuck));
}

TEST(OffsetValve, AJumpOfTheCommandIsCountedThoughItIsNearWhatIsRead) {
  const LoopFile loop = with("heated_tank", "heat", 0.5, 5.0, "offset");
  RunRecord record = runLoop(loop);
  const double applied = record.samples[200].measurement.input_applied[0];
  record.samples[200].action.input[0] = applied - 2.0;  // three from the command before
  record.samples[200].action.source = ActionSource::kBase;
  record.samples[199].action.source = ActionSource::kBase;
  EXPECT_GE(summarize(loop, record, 0.0).move_violations, 1U);
}

TEST(OffsetValve, SoftLimitsThatAreMissedAndOffsetsThatAreCutAreTold) {
  const LoopFile soft = readLoop(
      "methanol_clp", {{"clp.output_lower", "{T_17: 3}"}, {"clp.output_upper", "{T_17: 3}"}});
  EXPECT_NE(
      test::find(summarize(soft, runLoop(soft), 0.0).events, EventCode::kSoftLimitExceeded, "T_17"),
      nullptr);
  const LoopFile cut =
      readLoop("heated_tank",
               {{"disturbance.commands", "[{time_h: 0.5, name: T_in, value: -20, mode: offset}]"}});
  const Summary summary = summarize(cut, runLoop(cut), 0.0);
  const Event* told = test::find(summary.events, EventCode::kDisturbanceClamped, "T_in");
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->first, 60U);
  EXPECT_EQ(told->count, 300U);
}

TEST(OffsetValve, AnIdentificationThatFailsOrNeverBeginsIsTold) {
  const LoopFile few =
      readLoop("asp_identify", {{"sampling.duration_h", "4"}, {"model.identify.after", "10"}});
  const RunRecord record = runLoop(few);
  const Summary summary = summarize(few, record, 0.0);
  const Event* told = test::find(summary.events, EventCode::kIdentificationFailed);
  ASSERT_NE(told, nullptr);
  EXPECT_EQ(told->first, 10U);  // from sample 9; its model was to be used from the next one on
  EXPECT_EQ(told->count, 1U);
  const LoopFile never =
      readLoop("asp_identify", {{"sampling.duration_h", "4"}, {"model.identify.after", "22"}});
  EXPECT_TRUE(contains(summarize(never, runLoop(never), 0.0).events, EventCode::kBeyondRun));
}

TEST(OffsetValve, AModelThatTheControllerRefusesIsTheOnlyThingThatIsSaid) {
  const LoopFile loop = readLoop("asp_case1", {{"controller.delay_steps", "3"}});
  expectWords(errorOf([&] { runLoop(loop); }), {"asp_case1: controller: ", "delay_steps", "FM_1"});
}

}  // namespace loop_offset_valve_test
}  // namespace fpc
