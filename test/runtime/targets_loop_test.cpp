// Loops with a section targets in one process: plants that are not square rest where the ranks and
// prices say.
#include "events.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_targets_test {

/// Noise-free outputs, averaged over the last samples.
Vector atRest(const RunRecord& record, int samples = 20) {
  const std::size_t n = record.samples.size();
  Vector mean = Vector::Zero(record.samples.back().state.outputs.size());
  for (std::size_t k = n - static_cast<std::size_t>(samples); k < n; ++k)
    mean += record.samples[k].state.outputs / samples;
  return mean;
}

// h1 = 30 + 1.2 (p1 - 10) + 0.9 (p3 - 5), h2 = 25 + (p1 - 10) + 1.1 (p2 - 5) - 0.6 (p3 - 5)
// - 1.1 draw: with draw 4 the least is p2 = p3 = 0, p1 = 13.9, at h2 = 22.
TEST(TargetsLoop, MoreInputsThanOutputsRestAtTheLeastCost) {
  const LoopFile loop = readLoop("tanks_three_pumps");
  const RunRecord record = runLoop(loop);
  const Vector y = atRest(record);
  EXPECT_GT(y[0], 25.0 - 0.2);
  EXPECT_LT(y[0], 40.0 + 0.2);
  EXPECT_NEAR(y[1], 22.0, 0.3);
  Vector u = Vector::Zero(3);
  for (std::size_t k = record.samples.size() - 21; k + 1 < record.samples.size(); ++k)
    u += record.samples[k].action.input / 20.0;
  EXPECT_NEAR(u[0] + 3.0 * u[1], 13.9, 0.7);
  EXPECT_TRUE(summarize(loop, record, 0.0).complete);
}

// Of t1 = 4, t2 = 8 both are given up for t4 <= 2.5 of rank 1.
TEST(TargetsLoop, FewerInputsThanOutputsGiveUpTheLowerRank) {
  for (const bool clp : {true, false}) {
    const LoopFile loop = readLoop("four_on_two", clp ? Overrides{} : Overrides{{"clp", "false"}});
    const RunRecord record = runLoop(loop);
    const Vector y = atRest(record);
    EXPECT_LT(y[2], 5.0 + 0.1) << clp;
    EXPECT_LT(y[3], 2.5 + 0.1) << clp;
    const Summary summary = summarize(loop, record, 0.0);
    bool upper_rank = false, lower_rank = false;
    for (const Event& event : summary.events) {
      if (event.code != EventCode::kTargetGivenUp) continue;
      lower_rank = lower_rank || event.signal == "t1" || event.signal == "t2";
      upper_rank = upper_rank || event.signal == "t3" || event.signal == "t4";
    }
    EXPECT_TRUE(lower_rank) << clp;
    EXPECT_FALSE(upper_rank) << clp;
  }
}

TEST(TargetsLoop, AZoneUpsideDownIsAnError) {
  EXPECT_THROW(readLoop("tanks_three_pumps", {{"targets.outputs.h1.zone", "[50, 40]"}}),
               InputError);
}

TEST(TargetsLoop, WithoutTheSectionNothingChanges) {
  const LoopFile off = readLoop("tanks_three_pumps", {{"targets", "false"}});
  const RunRecord record = runLoop(off);
  EXPECT_EQ(record.samples.back().tracking.setpoint[0], 30.0);
}

}  // namespace loop_targets_test
}  // namespace fpc
