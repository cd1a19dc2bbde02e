// PI with gains that follow the output, and the path that baselines are scored by.
#include <gtest/gtest.h>

#include <limits>

#include "control/pi/pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_pi_pi_schedule_test {

Vector one(double value) { return Vector::Constant(1, value); }

class ScheduledPi : public ::testing::Test {
 protected:
  ScheduledPi() : setpoint_({one(2.0), {}, {}, {}, {}, {}}, {"y"}, SampleClock(360.0, 1.0)) {
    info_.sample_time_s = 360.0;  // 0.1 h
    info_.outputs = {{"y", "m", -10, 10}};
    info_.inputs = {{"u", "m", -1e9, 1e9}};
    PiLoop loop;
    loop.kp = 10.0;
    loop.ki_per_h = 20.0;
    loop.bias = 5.0;
    loop.gain_schedule = {{0.0, 1.0}, {1.0, 3.0}, {2.0, 0.5}};
    params_.loops = {loop};
  }
  double step(PiController& pi, std::uint32_t k, double y) {
    const Measurement now{{0, 1, k}, one(y), Vector(), one(5.0), false};
    if (k == 0) pi.reset(now);
    setpoint_.advance(k);
    pi.step(now, setpoint_, out_);
    return out_.input[0];
  }
  PiController make() const {
    const double infinite = std::numeric_limits<double>::infinity();
    return {params_, {one(-1e9), one(1e9), one(infinite)}, info_};
  }

  PiParams params_;
  PlantInfo info_;
  SetpointSource setpoint_;
  ControllerOutput out_;
};

TEST_F(ScheduledPi, MultipliesBothGainsByTheScheduleAtTheMeasuredOutput) {
  const std::vector<std::pair<double, double>> gains = {{-5.0, 1.0}, {0.0, 1.0},  {0.25, 1.5},
                                                        {1.0, 3.0},  {1.5, 1.75}, {7.0, 0.5}};
  PiController pi = make();
  double integral = 0.0;
  std::uint32_t k = 0;
  for (const auto& [y, g] : gains) {
    const double e = g * (2.0 - y);
    EXPECT_NEAR(step(pi, k++, y), 5.0 + 10.0 * e + integral, 1e-12) << "y " << y;
    integral += 20.0 * e * 0.1;
  }
}

// From y = 0.5 to 1.0 in 0.1 h the derivative is -0.3 * 5 = -1.5 whatever g is, 2 and 3 there;
// the proportional part 10 * 3 * 1, the integral 20 * 2 * 1.5 * 0.1.
TEST_F(ScheduledPi, LeavesTheDerivativeAsItIs) {
  params_.loops[0].terms.kd_h = 0.3;
  PiController pi = make();
  EXPECT_NEAR(step(pi, 0, 0.5), 5.0 + 10.0 * 2.0 * 1.5, 1e-12);
  EXPECT_NEAR(step(pi, 1, 1.0), 5.0 + 30.0 + 6.0 - 1.5, 1e-12);
}

TEST_F(ScheduledPi, PublishesThePathToTheSetpointAndFollowsTheSetpointItself) {
  PiController plain = make();
  const double before = step(plain, 0, 1.0);
  EXPECT_EQ(out_.reference[0], 2.0);
  params_.reference_pole = one(0.9);
  PiController scored = make();
  double y_r = 1.0;
  for (std::uint32_t k = 0; k < 20; ++k) {
    const double u = step(scored, k, 1.0);
    EXPECT_TRUE(k > 0 || u == before);
    EXPECT_NEAR(out_.reference[0], y_r, 1e-14);
    y_r = 0.9 * y_r + 0.1 * 2.0;
  }
}

TEST_F(ScheduledPi, RefusesASchedulesWithoutOrderOrWithoutGain) {
  const auto refused = [&](const std::vector<CurvePoint>& points) {
    params_.loops[0].gain_schedule = points;
    try {
      make();
    } catch (const InputError& e) {
      return std::string(e.what()).find("loops[0].gain_schedule") != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused({{1.0, 1.0}, {1.0, 2.0}}));
  EXPECT_TRUE(refused({{2.0, 1.0}, {1.0, 2.0}}));
  EXPECT_TRUE(refused({{0.0, 0.0}}));
  EXPECT_TRUE(refused({{std::numeric_limits<double>::quiet_NaN(), 1.0}}));
  EXPECT_FALSE(refused({{0.0, 1.0}}));
  params_.reference_pole = one(1.0);
  EXPECT_THROW(make(), InputError);
}

}  // namespace control_pi_pi_schedule_test
}  // namespace fpc
