// The adaptive loops sample by sample, on a column made of its elements.
#include "control/pi/adaptive_pi.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "control/pi/adaptive_fixture.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_pi_adaptive_pi_test {

using test::AdaptiveColumn;
using test::adaptiveParams;

TEST(AdaptivePi, WithoutAdaptationIsPiBehindTheDecoupling) {
  AdaptivePiParams params = adaptiveParams();
  params.adaptation.enabled = false;
  AdaptiveColumn column(params);
  column.step(1.0, 0.0);
  EXPECT_DOUBLE_EQ(column.output.input[0], 0.5 * (1.0 + 1.0 / 20.0)) << "kp (e + e dt / Ti)";
  EXPECT_DOUBLE_EQ(column.output.input[1], 0.0);
  EXPECT_FALSE(column.law.adapt(true));
}

TEST(AdaptivePi, LearnsAGainJumpAndScalesItsOwnGain) {
  AdaptiveColumn column(adaptiveParams());
  column.wander(200);
  EXPECT_NEAR(column.law.gainInUse(0, 0), 12.8, 0.01);
  column.scaleGains(1.2, 0.8);
  column.wander(400);
  EXPECT_NEAR(column.law.gainInUse(0, 0), 15.36, 0.05);
  EXPECT_NEAR(column.law.gainInUse(0, 1), -15.12, 0.05);
  EXPECT_NEAR(column.law.gainInUse(1, 0), 7.92, 0.05);
  EXPECT_NEAR(column.law.gainInUse(1, 1), -15.52, 0.05);
  EXPECT_NEAR(column.law.kp(0), 0.5 * 12.8 / 15.36, 0.002);
}

TEST(AdaptivePi, StaysAsItIsWhileFrozenAndLearnsOnWhenReleased) {
  AdaptiveColumn column(adaptiveParams());
  column.wander(200);
  EXPECT_TRUE(column.law.adapt(false));
  const double kp = column.law.kp(0), gain = column.law.estimator(0).gain(0);
  column.scaleGains(1.2, 0.8);
  column.wander(300);
  EXPECT_EQ(column.law.kp(0), kp);
  EXPECT_EQ(column.law.estimator(0).gain(0), gain);
  EXPECT_TRUE(column.law.adapt(true));
  column.wander(400);
  EXPECT_NEAR(column.law.gainInUse(0, 0), 15.36, 0.1);
}

TEST(AdaptivePi, KeepsTheLastGoodTuningWhenTheEstimatesAreAbsurd) {
  AdaptiveColumn column(adaptiveParams());
  column.wander(200);
  const double kp = column.law.kp(0);
  column.scaleGains(8.0, 8.0);  // beyond ratio_upper
  column.wander(60, 0.02);
  EXPECT_GT(column.law.kp(0), kp / 2.0 * 0.99) << "never beyond the guard";
  column.scaleGains(1.0, 1.0);
  column.wander(500);
  EXPECT_NEAR(column.law.kp(0), kp, 0.02 * kp) << "and back again";
}

TEST(AdaptivePi, ChangesAGainInUseNoFasterThanAllowed) {
  AdaptivePiParams params = adaptiveParams();
  params.adaptation.change_upper = 0.01;
  AdaptiveColumn column(params);
  column.wander(200);
  column.scaleGains(1.4, 0.7);
  double before = column.law.gainInUse(0, 0);
  for (int k = 0; k < 200; ++k) {
    column.wander(1);
    const double now = column.law.gainInUse(0, 0);
    EXPECT_LE(std::abs(now - before), 0.01 * std::abs(before) * (1.0 + 1e-12));
    before = now;
  }
}

TEST(AdaptivePi, TeachesItselfNothingFromOutputsBeyondTheirRange) {
  AdaptiveColumn column(adaptiveParams());
  column.wander(200);
  const double gain = column.law.estimator(0).gain(0);
  column.output_fault = 1e6;
  column.wander(100);
  EXPECT_EQ(column.law.estimator(0).gain(0), gain);
  EXPECT_LE(column.output.input.cwiseAbs().maxCoeff(), 2.0);
  EXPECT_TRUE(column.output.ok);
}

TEST(AdaptivePi, GoesOnBumplesslyInTheMiddleOfARun) {
  AdaptiveColumn column(adaptiveParams());
  column.wander(100);
  const Vector before = column.output.input;
  column.law.reset(column.measure());
  column.step(1.0, 0.5);
  EXPECT_NEAR(column.output.input[0], before[0], 1e-12);
  EXPECT_NEAR(column.output.input[1], before[1], 1e-12);
}

TEST(AdaptivePi, DoesNotWindUpAtItsLimits) {
  AdaptivePiParams params = adaptiveParams();
  params.adaptation.enabled = false;
  AdaptiveColumn column(params, 0.05);
  for (int k = 0; k < 300; ++k) column.step(5.0, 0.0);  // out of reach
  EXPECT_NEAR(column.output.input[0], 0.05, 1e-12);
  int samples = 0;
  for (; samples < 20 && column.output.input[0] > 0.0; ++samples) column.step(-1.0, 0.0);
  EXPECT_LT(samples, 5);
}

TEST(AdaptivePi, RefusesWhatItCannotDo) {
  AdaptivePiParams params = adaptiveParams();
  params.model[0][1].dead_time = 0.0;
  EXPECT_THROW(AdaptiveColumn column(params), InputError);
  params = adaptiveParams();
  params.loops[1].input = 0;
  EXPECT_THROW(AdaptiveColumn column(params), InputError);
  params = adaptiveParams();
  params.loops[0].ki_per_h = 0.0;
  EXPECT_THROW(AdaptiveColumn column(params), InputError);
  params = adaptiveParams();
  params.adaptation.ratio_upper = 1.0;
  EXPECT_THROW(AdaptiveColumn column(params), InputError);
}

}  // namespace control_pi_adaptive_pi_test
}  // namespace fpc
