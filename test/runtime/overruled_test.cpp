// What a loop file asks and cannot have is told before anybody wonders.
#include <gtest/gtest.h>

#include "runtime/loop_fixture.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_overruled_test {

std::string told(const char* name, const Overrides& overrides) {
  const LoopFile loop = readLoop(name, overrides);
  std::string all;
  for (const RunRemark& remark : summarize(loop, recordLayout(loop).emptyRecord(), 0.0).remarks)
    all += remark.words + "|";
  return all;
}

TEST(Overruled, ANominalDisturbanceThatThePatternGives) {
  EXPECT_EQ(told("asp_case1_pi_x", {}), "");
  expectWords(told("asp_case1_pi_x", {{"disturbance.nominal.q_i", "1999"}}),
              {"disturbance.nominal of q_i", "pattern"});
  EXPECT_EQ(told("asp_case1_pi_x",
                 {{"disturbance.nominal.q_i", "1999"}, {"disturbance.source", "constant"}}),
            "");
}

TEST(Overruled, ASetpointBeyondTheModelsData) {
  EXPECT_EQ(told("asp_case_c_own", {}), "");
  expectWords(told("asp_case_c_own", {{"setpoint.initial.x", "3500"}}),
              {"x is asked to be 3500", "no data", "1182", "2565"});
  EXPECT_EQ(told("asp_case_c_own", {{"setpoint.initial.s", "3500"}}), "")
      << "an output that the law does not steer";
  expectWords(told("asp_case_c_own", {{"setpoint.schedule", "[{time_h: 2, x: 900}]"}}),
              {"x is asked to be 900"});
}

/// 15 m at 0.5 m/s are five samples, those of the model; at 0.4 m/s six and a quarter.
TEST(LateLines, ASampleLineThatTheModelDoesNotKnowIsToldOnce) {
  const auto said = [](const char* name, const char* velocity) {
    const RunRecord run = runLoop(readLoop(
        name, {{"tf.sample_lines.0.velocity_m_s", velocity}, {"sampling.duration_h", "0.01"}}));
    std::string all;
    for (const SampleRecord& sample : run.samples)
      if (sample.remark.find("CA shows") != std::string::npos) all += sample.remark + "|";
    return all;
  };
  EXPECT_EQ(said("cstr_tracking_lags", "0.5"), "");
  EXPECT_EQ(said("cstr_tracking_lags", "0.43"), "")
      << "5.8 samples: what comes in the sixth is less, but not nothing";
  EXPECT_EQ(
      said("cstr_tracking_lags", "0.4"),
      "CA shows an input only after 37.5 s (tf.sample_lines), where model 'cstr_lags' expects "
      "it within 36 s|");
  EXPECT_NE(said("cstr_tracking_lags", "0.417"), "") << "36 s but for 0.03";
  EXPECT_EQ(said("cstr_tracking_pi", "0.4"), "") << "no model";
}

}  // namespace loop_overruled_test
}  // namespace fpc
