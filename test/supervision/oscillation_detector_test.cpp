// Inputs thrown from end to end: found, calmed, and told from steps that are meant.
#include "supervision/oscillation_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fpc {
namespace control_oscillation_detector_test {

TEST(OscillationDetector, ThirdTurnIsASwingAndEachFurtherOneHalvesTheMoves) {
  OscillationDetector watch(0.25, 100);
  EXPECT_EQ(watch.allow(0.5), 1.0);
  EXPECT_EQ(watch.allow(-0.5), 1.0);
  EXPECT_EQ(watch.allow(0.1), 1.0) << "a small move between is no end of it";
  EXPECT_EQ(watch.allow(0.5), 1.0);
  EXPECT_EQ(watch.allow(-0.5), 0.125);
  EXPECT_TRUE(watch.swings());
  EXPECT_EQ(watch.allow(0.5), 0.0625);
  for (int k = 0; k < 20; ++k) watch.allow(k % 2 == 0 ? -0.5 : 0.5);
  EXPECT_EQ(watch.allow(-0.5), 0.02);
}

TEST(OscillationDetector, OpensByHalfInItsTime) {
  OscillationDetector watch(0.25, 10);
  for (int k = 0; k < 4; ++k) watch.allow(k % 2 == 0 ? -0.5 : 0.5);
  double allowed = 0.0;
  for (int k = 0; k < 10; ++k) allowed = watch.allow(0.0);
  EXPECT_NEAR(allowed, 0.125 * 1.5, 1e-12);
  for (int k = 0; k < 100; ++k) allowed = watch.allow(0.0);
  EXPECT_EQ(allowed, 1.0);
  EXPECT_FALSE(watch.swings());
}

TEST(OscillationDetector, StepsWithPausesAndOneWayTravelAreNoSwings) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> size(0.26, 1.0), small(-0.25, 0.25);
    OscillationDetector watch(0.25, 100);
    for (int k = 0; k < 400; ++k) {
      const double sign = (k / 12) % 2 == 0 ? 1.0 : -1.0;
      ASSERT_EQ(watch.allow(k % 12 == 0 ? sign * size(engine) : small(engine)), 1.0) << seed;
    }
    for (int k = 0; k < 50; ++k) ASSERT_EQ(watch.allow(size(engine)), 1.0) << seed;
  }
}

TEST(OscillationDetector, WishHeldOneWayForMoreThanAWindowIsNoSwing) {
  OscillationDetector watch(0.25, 250);
  for (int k = 0; k < 30; ++k) watch.allow(k % 2 == 0 ? -0.5 : 0.5);
  ASSERT_TRUE(watch.swings());
  double allowed = 0.0;
  for (int k = 0; k < 12; ++k) allowed = watch.allow(-0.5);
  EXPECT_LT(allowed, 0.03) << "within the window it may still be one";
  for (int k = 0; k < 12; ++k) allowed = watch.allow(-0.5);
  EXPECT_EQ(allowed, 1.0);
  EXPECT_FALSE(watch.swings());
}

TEST(OscillationDetector, OffMeansOff) {
  OscillationDetector watch(0.0, 100);
  for (int k = 0; k < 50; ++k) EXPECT_EQ(watch.allow(k % 2 == 0 ? -1.0 : 1.0), 1.0);
}

}  // namespace control_oscillation_detector_test
}  // namespace fpc
