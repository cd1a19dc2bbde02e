// Gains that change while the loop runs: no bump, and from then on the new law.
#include <gtest/gtest.h>

#include "control/pi/pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_pi_pi_retune_test {

constexpr double kSampleTime = 720.0;  // 0.2 h

/// One loop from output y to input u, bias 500, setpoint 10; stepped by hand.
class PiRetune : public ::testing::Test {
 protected:
  PiRetune() : setpoint_(setpoints(), {"y"}, SampleClock(kSampleTime, 1.0)) {
    PlantInfo plant;
    plant.sample_time_s = kSampleTime;
    plant.outputs = {{"y", "", 0, 100}};
    plant.inputs = {{"u", "", 0, 1000}};
    PiLoop loop;
    loop.kp = 2.0;
    loop.ki_per_h = 5.0;
    loop.bias = 500.0;
    InputLimits limits{Vector::Zero(1), Vector::Constant(1, 1000.0),
                       Vector::Constant(1, std::numeric_limits<double>::infinity())};
    pi_ = std::make_unique<PiController>(PiParams{{loop}, {}}, limits, plant);
  }
  static SetpointParams setpoints() {
    SetpointParams p;
    p.initial = Vector::Constant(1, 10.0);
    return p;
  }
  double next(double y) {
    Measurement now{
        {0, 1, step_++}, Vector::Constant(1, y), {}, Vector::Constant(1, applied_), false};
    if (now.header.step == 0) pi_->reset(now);
    pi_->step(now, setpoint_, out_);
    return applied_ = out_.input[0];
  }

  SetpointSource setpoint_;
  std::unique_ptr<PiController> pi_;
  ControllerOutput out_;
  double applied_{500.0};
  std::uint32_t step_{0};
};

TEST_F(PiRetune, TheInputGoesOnAsTheOldGainsHaveItAndThenFollowsTheNewOnes) {
  EXPECT_DOUBLE_EQ(next(6.0), 508.0);  // 500 + 2 4
  EXPECT_DOUBLE_EQ(next(6.0), 512.0);  // + 5 0.2 4
  EXPECT_TRUE(pi_->retune({{"kp", "u=3"}, {"ki_per_h", "10"}}));
  EXPECT_NEAR(next(6.0), 516.0, 1e-12);        // what the old gains say
  EXPECT_NEAR(next(6.0), 516.0 + 8.0, 1e-12);  // + 10 0.2 4
  EXPECT_NEAR(next(5.0), 524.0 + 8.0 + 3.0, 1e-12);
}

TEST_F(PiRetune, BeforeTheFirstSampleThereIsNothingToKeep) {
  pi_->retune({{"kp", "3"}});
  EXPECT_DOUBLE_EQ(next(6.0), 512.0);
}

TEST_F(PiRetune, SettingsShowTheLatestAndReadBack) {
  next(6.0);
  EXPECT_EQ(pi_->settings(), (Settings{{"kp", "u=2"}, {"ki_per_h", "u=5"}}));
  pi_->retune({{"kp", "0.5"}});
  EXPECT_EQ(pi_->settings(), (Settings{{"kp", "u=0.5"}, {"ki_per_h", "u=5"}}));
  pi_->retune(pi_->settings());
  next(6.0);
  EXPECT_EQ(pi_->settings(), (Settings{{"kp", "u=0.5"}, {"ki_per_h", "u=5"}}));
}

TEST_F(PiRetune, WhatIsRefusedChangesNothing) {
  next(6.0);
  for (const Settings& bad :
       {Settings{{"kp", "v=1"}}, Settings{{"kp", "1 2"}}, Settings{{"ki_per_h", ""}},
        Settings{{"kp", "1"}, {"bias", "3"}}, Settings{{"kp", "inf"}}})
    EXPECT_THROW(pi_->retune(bad), InputError);
  EXPECT_EQ(pi_->settings(), (Settings{{"kp", "u=2"}, {"ki_per_h", "u=5"}}));
  EXPECT_DOUBLE_EQ(next(6.0), 512.0);
}

}  // namespace control_pi_pi_retune_test
}  // namespace fpc
