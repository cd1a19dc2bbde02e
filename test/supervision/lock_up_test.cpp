// Lock-ups of a plant on paper: found, left, and told from an honest saturation.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "supervision/guard.hpp"

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

/// A watch whose upper bound was drawn in for an output that lay above its setpoint.
LockUpWatch drawnForTooMuch(const GuardParams& p = params()) {
  LockUpWatch lock(p, 0.0, 1.0);
  double error = 5.0;
  for (int k = 0; k < 24; ++k) {
    error += k < 12 ? 0.1 : -0.05;  // the trial helps
    lock.observe(lock.upper(), error, -1);
  }
  return lock;
}

// What was drawn in against too much of an output holds it down once there is too little of it: the
// bound opens by lock_step 0.1 in lock_samples 12, not over the 200 samples of lock_release.
TEST(LockUp, OnTheOtherSideOfTheSetpointTheBoundOpensAsFastAsItWasDrawnIn) {
  GuardParams slow = params();
  slow.lock_release = 200;
  LockUpWatch lock = drawnForTooMuch(slow);
  const double drawn = 1.0 - lock.upper();
  ASSERT_NEAR(drawn, 0.095, 1e-12);  // it has begun to open, by a two-hundredth
  for (int k = 1; k <= 6; ++k) {
    lock.observe(lock.upper(), 2.0 + k, 1);  // at the bound, and the error grows
    EXPECT_NEAR(lock.upper(), 1.0 - drawn + k * 0.1 / 12.0, 1e-12) << k;
  }
  for (int k = 0; k < 40; ++k) lock.observe(0.5, 9.0, 1);
  EXPECT_FALSE(lock.drawnIn());
}

TEST(LockUp, OnTheOtherSideItNeverOpensMoreSlowlyThanElsewhere) {
  GuardParams quick = params();
  quick.lock_release = 20;  // 0.05 a sample beside 0.1 / 12
  LockUpWatch lock = drawnForTooMuch(quick);
  ASSERT_NEAR(lock.upper(), 0.95, 1e-12);
  lock.observe(lock.upper(), 3.0, 1);
  EXPECT_NEAR(lock.upper(), 1.0, 1e-12);
}

TEST(LockUp, AnotherOutputOrALittleErrorOnTheOtherSideOpensItSlowly) {
  for (const auto& [error, whose] : {std::pair{9.0, 2}, std::pair{9.0, -1}, std::pair{0.9, 1}}) {
    LockUpWatch lock = drawnForTooMuch();
    const double before = lock.upper();
    lock.observe(0.3, error, whose);  // the law has left the bound
    EXPECT_NEAR(lock.upper(), before + 0.01, 1e-12) << error << " " << whose;
  }
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
