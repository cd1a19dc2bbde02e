// Lock-ups of a plant on paper: found, left, and told from an honest saturation.
#include <gtest/gtest.h>

#include <algorithm>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/guard.hpp"

namespace fpc {
namespace control_lock_up_test {

GuardParams params() {
  GuardParams p;
  p.lock_samples = 12;
  p.lock_step = 0.1;
  p.lock_release = 100;
  return p;
}

/// y = gain(u) behind a lag of 5 samples; a law that asks for the upper bound 1 for ever.
template <typename Gain>
struct Pushed {
  explicit Pushed(Gain g) : gain(g), lock(params(), 0.0, 1.0) {}
  bool run(int samples, double setpoint) {
    bool ever = false;
    for (int k = 0; k < samples; ++k) {
      u = std::clamp(1.0, lock.lower(), lock.upper());
      y += 0.2 * (gain(u) - y);
      ever = lock.observe(u, std::abs(setpoint - y) / (0.02 * setpoint)) || ever;
    }
    return ever;
  }
  Gain gain;
  LockUpWatch lock;
  double u{1.0}, y{0.0};
};

double hill(double u) { return 4.0 * u * (1.0 - u); }  // 1 at 0.5, 0 at both bounds
double line(double u) { return 0.5 * u; }

TEST(LockUp, PastTheTopOfAHillItIsFoundAndLeft) {
  Pushed<double (*)(double)> loop(hill);
  loop.y = 0.9;
  EXPECT_TRUE(loop.run(200, 0.9));
  EXPECT_TRUE(loop.lock.drawnIn());
  EXPECT_GT(loop.y, 0.7);  // at the bound it was 0
  EXPECT_LT(loop.u, 0.8);
}

TEST(LockUp, WithinThreeWindows) {
  Pushed<double (*)(double)> loop(hill);
  loop.y = 0.9;
  EXPECT_FALSE(loop.run(12, 0.9));
  EXPECT_TRUE(loop.run(24, 0.9));
}

TEST(LockUp, AnHonestSaturationIsTriedAndLeftAlone) {
  Pushed<double (*)(double)> loop(line);  // 0.5 at most, 0.9 asked
  EXPECT_FALSE(loop.run(400, 0.9));
  EXPECT_GT(loop.y, 0.44);  // a trial costs a tenth of the input at most
}

TEST(LockUp, AnErrorInsideItsToleranceIsNone) {
  Pushed<double (*)(double)> loop(line);
  loop.y = 0.5;
  EXPECT_FALSE(loop.run(100, 0.505));
  EXPECT_FALSE(loop.lock.drawnIn());
}

TEST(LockUp, ABoundOpensAgainWhenTheLawLeavesIt) {
  Pushed<double (*)(double)> loop(hill);
  loop.y = 0.9;
  loop.run(100, 0.9);
  ASSERT_TRUE(loop.lock.drawnIn());
  for (int k = 0; k < 101; ++k) loop.lock.observe(0.3, 0.0);
  EXPECT_FALSE(loop.lock.drawnIn());
  EXPECT_EQ(loop.lock.upper(), 1.0);
}

TEST(LockUp, LowerBoundsLockAsWell) {
  LockUpWatch lock(params(), 0.0, 1.0);
  double y = 0.9, u = 0.0;
  bool ever = false;
  for (int k = 0; k < 200; ++k) {
    u = std::clamp(0.0, lock.lower(), lock.upper());
    y += 0.2 * (hill(u) - y);
    ever = lock.observe(u, std::abs(0.9 - y) / 0.018) || ever;
  }
  EXPECT_TRUE(ever);
  EXPECT_GT(u, 0.2);
}

TEST(LockUp, ZeroSamplesSwitchItOff) {
  GuardParams off = params();
  off.lock_samples = 0;
  LockUpWatch lock(off, 0.0, 1.0);
  for (int k = 0; k < 100; ++k) EXPECT_FALSE(lock.observe(1.0, 50.0 + k));
  EXPECT_EQ(lock.upper(), 1.0);
}

}  // namespace control_lock_up_test
}  // namespace fpc
