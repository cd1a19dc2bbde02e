// Inputs thrown from end to end: found, and told from steps that are meant.
#include "supervision/oscillation_detector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fpc {
namespace control_oscillation_detector_test {

TEST(OscillationDetector, TheThirdTurnIsASwing) {
  OscillationDetector watch(0.25);
  EXPECT_FALSE(watch.add(0.5));
  EXPECT_FALSE(watch.add(-0.5));
  EXPECT_FALSE(watch.add(0.1)) << "a small move between is no end of it";
  EXPECT_FALSE(watch.add(std::nan("")));
  EXPECT_FALSE(watch.add(0.5));
  EXPECT_TRUE(watch.add(-0.5));
  EXPECT_TRUE(watch.add(0.0));
  watch.reset();
  EXPECT_FALSE(watch.add(0.5));
}

TEST(OscillationDetector, StepsWithPausesAndOneWayTravelAreNoSwings) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 engine(seed);
    std::uniform_real_distribution<double> size(0.26, 1.0), small(-0.25, 0.25);
    OscillationDetector watch(0.25);
    for (int k = 0; k < 400; ++k) {
      const double sign = (k / 12) % 2 == 0 ? 1.0 : -1.0;
      ASSERT_FALSE(watch.add(k % 12 == 0 ? sign * size(engine) : small(engine))) << seed;
    }
    for (int k = 0; k < 50; ++k) ASSERT_FALSE(watch.add(size(engine))) << seed;
  }
}

}  // namespace control_oscillation_detector_test
}  // namespace fpc
