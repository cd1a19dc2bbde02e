// What the controller rejected is not in the scores, nor outside the data of its model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "events.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_rejected_scores_test {

constexpr Eigen::Index kX = 1;

RunRecord recordOf(const LoopFile& loop) {
  RunRecord record = runLoop(loop);
  for (SampleRecord& sample : record.samples)  // no noise: the scores can be compared
    sample.measurement.outputs = sample.state.outputs;
  return record;
}

/// No two readings are the same.
void fail(RunRecord& record, double value, Eigen::Index output = kX) {
  for (const std::size_t k : {10, 11, 30})
    record.samples[k].measurement.outputs[output] = value - static_cast<double>(k);
}

TEST(RejectedScores, OfASimulatedPlantAreThoseOfWhatWasTrue) {
  const LoopFile loop =
      readLoop("asp_case1_pi_x", {{"sampling.duration_h", "10"},
                                  {"plausibility.signals.x.range", "[-1000, 3000]"},
                                  {"report.windows", "[{name: w, between_s: [7200, 25200]}]"}});
  const RunRecord record = recordOf(loop);
  const Summary well = summarize(loop, record, 0.0);
  EXPECT_EQ(well.outputs[kX].rejected, 0U);
  for (const double value : {9e9, std::nan("")}) {
    RunRecord failed = record;
    fail(failed, value);
    const Summary summary = summarize(loop, failed, 0.0);
    EXPECT_EQ(summary.outputs[kX].ise, well.outputs[kX].ise);
    EXPECT_EQ(summary.outputs[kX].itae, well.outputs[kX].itae);
    EXPECT_EQ(summary.windows[kX].rmse, well.windows[kX].rmse);
    EXPECT_EQ(summary.outputs[kX].rejected, 3U);
    EXPECT_EQ(summary.outputs[0].rejected, 0U);
    const Event* rejected = test::find(summary.events, EventCode::kMeasurementRejected);
    ASSERT_NE(rejected, nullptr);
    EXPECT_EQ(rejected->signal, "x");
    EXPECT_EQ(rejected->count, 3U);
    EXPECT_EQ(rejected->first, 10U);
    EXPECT_NE(toJson(summary).find("\"rejected\": 3"), std::string::npos);
  }
}

TEST(RejectedScores, OfAnotherPlantLeaveThemOut) {
  const LoopFile loop =
      readLoop("asp_case1_pi_x",
               {{"sampling.duration_h", "10"}, {"plausibility.signals.x.range", "[-1000, 3000]"}});
  RunRecord record = recordOf(loop);
  fail(record, 9e9);
  double ise = 0.0, itae = 0.0;
  std::size_t samples = 0;
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    SampleRecord& sample = record.samples[k];
    sample.has_state = false;
    const double e = sample.tracking.setpoint[kX] - sample.measurement.outputs[kX];
    if (std::abs(e) > 1e6) continue;
    ise += e * e;
    itae += 0.2 * static_cast<double>(k) * std::abs(e);
    ++samples;
  }
  const Summary summary = summarize(loop, record, 0.0);
  EXPECT_NEAR(summary.outputs[kX].ise, ise, 1e-9 * ise);
  EXPECT_NEAR(summary.outputs[kX].itae, itae, 1e-9 * itae);  // time goes on
  EXPECT_NEAR(summary.outputs[kX].rmse, std::sqrt(ise / static_cast<double>(samples)), 1e-9);
  for (SampleRecord& sample : record.samples) sample.measurement.outputs[kX] = 9e9;
  EXPECT_TRUE(std::isnan(summarize(loop, record, 0.0).outputs[kX].ise));  // nothing is known
}

TEST(RejectedScores, ARejectedMeasurementIsNotOutsideTheModel) {
  const LoopFile loop = readLoop("asp_best", {{"sampling.duration_h", "10"},
                                              {"plausibility.signals.x.range", "[-1000, 9000]"}});
  RunRecord record = recordOf(loop);
  const std::uint64_t before = summarize(loop, record, 0.0).outside_model;
  const std::vector<SignalInfo>& outputs = loop.plant_info.outputs;
  const auto x = std::find_if(outputs.begin(), outputs.end(),
                              [](const SignalInfo& output) { return output.name == "x"; }) -
                 outputs.begin();
  fail(record, 9100.0, x);
  EXPECT_EQ(summarize(loop, record, 0.0).outside_model, before);
  EXPECT_EQ(samplesOutsideModel(loop, record), before);
}

}  // namespace loop_rejected_scores_test
}  // namespace fpc
