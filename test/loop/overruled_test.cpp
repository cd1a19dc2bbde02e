// What a loop file asks and cannot have is told before anybody wonders.
#include <gtest/gtest.h>

#include "fmbpc/loop/recorder_session.hpp"
#include "fmbpc/loop/report.hpp"
#include "loop/loop_fixture.hpp"

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
TEST(Overruled, ASampleLineThatTheModelDoesNotKnow) {
  const std::string speed = "tf.sample_lines.0.velocity_m_s";
  EXPECT_EQ(told("cstr_tracking_lags", {}).find("CA shows"), std::string::npos);
  EXPECT_EQ(told("cstr_tracking_lags", {{speed, "0.43"}}).find("CA shows"), std::string::npos)
      << "5.8 samples: what comes in the sixth is less, but not nothing";
  expectWords(told("cstr_tracking_lags", {{speed, "0.417"}}), {"CA shows an input only after"});
  expectWords(told("cstr_tracking_lags", {{speed, "0.4"}}),
              {"CA shows an input only after 37.5 s (tf.sample_lines)", "cstr_lags", "36 s"});
  EXPECT_EQ(told("cstr_tracking_pi", {{speed, "0.4"}}).find("CA shows"), std::string::npos)
      << "no model";
}

}  // namespace loop_overruled_test
}  // namespace fpc
