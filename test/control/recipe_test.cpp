// Schedules as recipes: ramps, hold and resume.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fmbpc/control/setpoint_source.hpp"

namespace fpc {
namespace control_recipe_test {

Vector two(double first, double second) {
  Vector values(2);
  values << first, second;
  return values;
}

SetpointParams params() {
  SetpointParams p;
  p.initial = two(55.0, 2000.0);
  return p;
}

SetpointSource source(const SetpointParams& p) {
  return SetpointSource(p, {"s", "x"}, SampleClock(720.0, 1.0));
}

// 0.2 h a sample: from 2000 at 0.4 h to 2400 at 1.2 h, 100 a sample.
TEST(SetpointSource, ARampIsAStraightLineFromTheEntryBefore) {
  SetpointParams p = params();
  p.schedule = {{0.4, two(kNaN, 2400.0), 0.8}, {2.0, two(kNaN, 2000.0)}};
  SetpointSource s = source(p);
  const double expected[] = {2000, 2000, 2000, 2100, 2200, 2300, 2400, 2400, 2400, 2400, 2000};
  for (std::uint32_t k = 0; k <= 10; ++k) {
    EXPECT_NEAR(s.advance(k)[1], expected[k], 1e-9) << "sample " << k;
    EXPECT_EQ(s.present()[0], 55.0);
  }
  Vector ahead(2);
  s.scheduled(4, ahead);
  EXPECT_NEAR(ahead[1], 2200.0, 1e-9);
}

TEST(SetpointSource, AHeldScheduleWaitsAndGoesOnWhereItStopped) {
  SetpointParams p = params();
  p.schedule = {{0.4, two(kNaN, 2400.0), 0.8}, {2.0, two(kNaN, 2000.0)}};
  SetpointSource s = source(p), planned = source(p);
  std::vector<double> plan;
  for (std::uint32_t k = 0; k <= 12; ++k) plan.push_back(planned.advance(k)[1]);
  Vector ahead(2);
  for (std::uint32_t k = 0; k <= 22; ++k) {
    if (k == 3) s.hold(true);
    if (k == 10) s.hold(false);
    if (k == 15) s.hold(true);
    if (k == 18) s.hold(false);
    s.advance(k);
    const std::uint32_t late = k < 3 ? 0 : k < 10 ? k - 3 : k < 15 ? 7 : k < 18 ? k - 8 : 10;
    EXPECT_EQ(s.present()[1], plan[k - late]) << "sample " << k;
    s.scheduled(k + 5, ahead);
    if (s.held()) {
      EXPECT_EQ(ahead[1], s.present()[1]) << "sample " << k;
    }
  }
  s.hold(true);
  s.restart();
  EXPECT_FALSE(s.held());
  EXPECT_EQ(s.advance(4)[1], plan[4]);
}

TEST(SetpointSource, CommandsActWhileTheScheduleIsHeld) {
  SetpointSource s = source(params());
  s.hold(true);
  s.advance(0);
  s.command({0, {"x"}, {1500.0}, CommandMode::kOverride});
  EXPECT_EQ(s.advance(1)[1], 1500.0);
}

}  // namespace control_recipe_test
}  // namespace fpc
