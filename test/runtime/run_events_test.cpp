// What the summary says of messages that a record over topics lacks.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "events.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace runtime_run_events_test {

TEST(RunEvents, MessagesThatNeverCameAreTold) {
  const LoopFile loop =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}, {"setpoint.schedule", "[]"}});
  RunRecord record = runLoop(loop);
  const auto gaps = [&] {
    std::vector<Event> found;
    for (const Event& event : summarize(loop, record, 0.0).events)
      if (event.code == EventCode::kRecordGap) found.push_back(event);
    return test::shown(found);
  };
  using Lines = std::vector<std::string>;
  EXPECT_EQ(gaps(), Lines{});
  record.samples[3].has_action = record.samples[7].has_action = false;
  record.samples[4].has_report = false;
  EXPECT_EQ(gaps(),
            (Lines{"record_gap control_action 3..7 (2)", "record_gap solver_report 4..4 (1)"}));
  record.samples.resize(8);  // cut short: what its last sample lacks may have been on its way
  EXPECT_EQ(gaps(),
            (Lines{"record_gap control_action 3..3 (1)", "record_gap solver_report 4..4 (1)"}));
}

TEST(RunEvents, ASolveThatFailsAndAHeldInputAreSaid) {
  const LoopFile loop =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}, {"setpoint.schedule", "[]"}});
  RunRecord record = runLoop(loop);
  EXPECT_EQ(test::shown(summarize(loop, record, 0.0).events), std::vector<std::string>{});
  record.samples[5].report.status = SolveStatus::kInfeasible;
  record.samples[6].report.status = SolveStatus::kIterationLimit;
  record.samples[7].report.status = SolveStatus::kBoundWins;
  record.samples[9].action.source = record.samples[10].action.source = ActionSource::kHeld;
  record.samples[11].action.source = ActionSource::kFallback;
  EXPECT_EQ(test::shown(summarize(loop, record, 0.0).events),
            (std::vector<std::string>{"qp_not_solved  5..5 (1)", "qp_not_solved  6..6 (1)",
                                      "bounds_conflict  7..7 (1)", "input_held  9..10 (2)",
                                      "fallback_acts  11..11 (1)"}));
}

TEST(RunEvents, ASampleWithoutTheOptimizerIsSaid) {
  const LoopFile loop =
      readLoop("asp_case1_clp", {{"sampling.duration_h", "4"}, {"setpoint.schedule", "[]"}});
  RunRecord record = runLoop(loop);
  for (const std::size_t k : {5U, 6U, 9U, 12U}) {  // as the controller stands in for it
    record.samples[k].action.source = ActionSource::kBase;
    record.samples[k].report.status = SolveStatus::kNotRun;
  }
  record.samples[9].action.source = ActionSource::kManual;  // passed through by it
  EXPECT_EQ(test::shown(summarize(loop, record, 0.0).events),
            (std::vector<std::string>{"optimizer_lost  5..12 (3)"}));
}

}  // namespace runtime_run_events_test
}  // namespace fpc
