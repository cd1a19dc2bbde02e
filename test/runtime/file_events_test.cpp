// What a loop file asks and cannot have is said before anybody wonders.
#include <gtest/gtest.h>

#include "events.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace runtime_file_events_test {

std::vector<Event> events(const char* name, const Overrides& overrides) {
  const LoopFile loop = readLoop(name, overrides);
  return summarize(loop, recordLayout(loop).emptyRecord(), 0.0).events;
}

TEST(FileEvents, ANominalDisturbanceThatThePatternGives) {
  const auto says = [](const Overrides& overrides) {
    return test::find(events("asp_case1_pi_x", overrides), EventCode::kNominalOverruled, "q_i") !=
           nullptr;
  };
  EXPECT_FALSE(says({}));
  EXPECT_TRUE(says({{"disturbance.nominal.q_i", "1999"}}));
  EXPECT_FALSE(says({{"disturbance.nominal.q_i", "1999"}, {"disturbance.source", "constant"}}));
}

TEST(FileEvents, ASetpointBeyondTheModelsData) {
  const auto text = [](const Overrides& overrides) {
    const std::vector<Event> all = events("asp_case_c_own", overrides);
    const Event* found = test::find(all, EventCode::kSetpointOutsideModel);
    return found ? found->text : "";
  };
  EXPECT_EQ(text({}), "");
  expectWords(text({{"setpoint.initial.x", "3500"}}), {"3500", "1182", "2565"});
  EXPECT_EQ(text({{"setpoint.initial.s", "3500"}}), "") << "an output that the law does not steer";
  expectWords(text({{"setpoint.schedule", "[{time_h: 2, x: 900}]"}}), {"900"});
}

/// 15 m at 0.5 m/s are five samples, those of the model; at 0.4 m/s six and a quarter.
TEST(FileEvents, ASampleLineThatTheModelDoesNotKnowIsToldOnce) {
  const auto said = [](const char* name, const char* velocity) {
    const RunRecord run = runLoop(readLoop(
        name, {{"tf.sample_lines.0.velocity_m_s", velocity}, {"sampling.duration_h", "0.01"}}));
    const std::vector<Event> said = test::eventsOf(run);
    const Event* late = test::find(said, EventCode::kOutputDelayed, "CA");
    return late ? late->count : 0;
  };
  EXPECT_EQ(said("cstr_tracking_lags", "0.5"), 0U);
  EXPECT_EQ(said("cstr_tracking_lags", "0.43"), 0U)
      << "5.8 samples: what comes in the sixth is less, but not nothing";
  EXPECT_EQ(said("cstr_tracking_lags", "0.4"), 1U);
  EXPECT_EQ(said("cstr_tracking_lags", "0.417"), 1U) << "36 s but for 0.03";
  EXPECT_EQ(said("cstr_tracking_pi", "0.4"), 0U) << "no model";
}

}  // namespace runtime_file_events_test
}  // namespace fpc
