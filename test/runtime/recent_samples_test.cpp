#include "runtime/recent_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"
#include "model/gain_sign.hpp"
#include "random/dice.hpp"

namespace fpc {
namespace control_recent_samples_test {

/// y(k+1) = a y(k) + b u(k).
TsModel model(double a, double b) {
  return test::oneRule({test::signal("u")},
                       {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}},
                       Eigen::Vector2d(a, b));
}

/// Samples of y(k+1) = 0.8 y + 0.5 u under a random input.
void live(RecentSamples& recent, int samples) {
  Dice dice(1);
  Measurement m;
  m.outputs = m.input_applied = Vector::Zero(1);
  for (int k = 0; k < samples; ++k) {
    m.input_applied[0] = dice.between(-1.0, 1.0);
    m.outputs[0] = 0.8 * m.outputs[0] + 0.5 * m.input_applied[0];
    recent.add(m);
  }
}

TEST(RecentSamples, TheTrueModelErrsByNothingAndOneWithHalfTheGainByHalfTheInput) {
  RecentSamples recent(test::infoOf(model(0.8, 0.5)));
  live(recent, RecentSamples::kKept + 7);
  EXPECT_LE(recent.errorsOf(model(0.8, 0.5))[0], 1e-15);
  const double error = recent.errorsOf(model(0.8, 0.25))[0];
  EXPECT_NEAR(error, 0.25 / std::sqrt(3.0), 0.04);  // rms of a uniform input
  EXPECT_NEAR(recent.errorsOf(model(0.8, 0.0))[0], 2.0 * error, 1e-12);
}

TEST(RecentSamples, FewSamplesOrAGapSayNothing) {
  RecentSamples recent(test::infoOf(model(0.8, 0.5)));
  live(recent, RecentSamples::kFewest - 1);
  EXPECT_EQ(recent.errorsOf(model(0.8, 0.5)).size(), 0);
  live(recent, 1);
  EXPECT_EQ(recent.errorsOf(model(0.8, 0.5)).size(), 1);
  recent.reset();
  live(recent, 5);
  EXPECT_EQ(recent.errorsOf(model(0.8, 0.5)).size(), 0);
}

TEST(RecentSamples, AFewTellAWrongModelFromTheTrueOne) {
  for (int samples = RecentSamples::kFewest; samples <= RecentSamples::kKept + 9; ++samples) {
    RecentSamples recent(test::infoOf(model(0.8, 0.5)));
    live(recent, samples);
    EXPECT_LE(recent.errorsOf(model(0.8, 0.5))[0], 1e-15) << samples;
    EXPECT_GT(recent.errorsOf(model(-0.8, -0.5))[0], 0.1) << samples;
  }
}

TEST(RecentSamples, AModelThatTurnsAGainMustForeseeWhatCame) {
  RecentSamples recent(test::infoOf(model(0.8, 0.5)));
  live(recent, RecentSamples::kKept);
  const std::vector<TurnedGain> turned = {{"y", "u", 0}};
  const TsModel truth = model(0.8, 0.5), wrong = model(0.8, -0.5);
  EXPECT_NO_THROW(requireForeseen(turned, truth, recent.errorsOf(wrong), recent.errorsOf(truth)));
  EXPECT_NO_THROW(requireForeseen({}, wrong, recent.errorsOf(truth), recent.errorsOf(wrong)));
  EXPECT_NO_THROW(requireForeseen(turned, wrong, Vector(), Vector()));
  try {
    requireForeseen(turned, wrong, recent.errorsOf(truth), recent.errorsOf(wrong));
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("gain from u"), std::string::npos) << error.what();
  }
}

}  // namespace control_recent_samples_test
}  // namespace fpc
