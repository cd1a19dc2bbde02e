// What samples of a controlled loop say of a model: answers known on paper, open loop and under
// feedback.
#include "supervision/model_trial.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"
#include "random/dice.hpp"
#include "supervision/horizon_errors.hpp"
#include "supervision/promise.hpp"

namespace fpc {
namespace supervision_model_trial_test {

constexpr double kConfidence = 0.998;

/// y(k+1) = 0.8 y + gain (0.3 u(k-3) + 0.1 u(k-4)).
TsModel trialModel(double gain, int shift = 0) {
  return test::oneRule(test::numbered("u", 1),
                       {{SignalKind::kOutput, 0, 0},
                        {SignalKind::kInput, 0, 3 + shift},
                        {SignalKind::kInput, 0, 4 + shift}},
                       Eigen::Vector3d(0.8, 0.3 * gain, 0.1 * gain));
}

enum class Hand { kRandom, kFeedback, kStill };

/// The process of trialModel(1) with white noise, a drift of its load and noise of its sensor.
TrialFigures judged(const TsModel& model, Hand hand, std::uint64_t seed, int samples = 400,
                    double noise = 0.05) {
  ModelTrial trial(model, samples);
  Dice dice(seed);
  Measurement m;
  m.outputs = Vector::Zero(1);
  m.input_applied = Vector::Zero(1);
  m.disturbances = Vector::Zero(0);
  double y = 0.0, load = 0.0, past[5] = {}, setpoint = 1.0;
  while (trial.kept() < samples) {
    const double shown = y + noise * dice.between(-1.0, 1.0);
    m.outputs[0] = shown;
    m.input_applied[0] = past[0];
    trial.look(m);
    if (dice.chance(0.02)) setpoint = -setpoint;
    load += 0.01 * dice.between(-1.0, 1.0);
    for (int i = 4; i > 0; --i) past[i] = past[i - 1];
    past[0] = hand == Hand::kRandom     ? dice.between(-1.0, 1.0)
              : hand == Hand::kFeedback ? 0.15 * (setpoint - shown) + 0.4 * setpoint
                                        : 0.2;
    y = 0.8 * y + 0.3 * past[3] + 0.1 * past[4] + load + noise * dice.between(-1.0, 1.0);
  }
  return trial.judge(kConfidence);
}

TEST(ModelTrial, ARightModelIsRightUnderRandomMovesAndUnderFeedback) {
  for (const Hand hand : {Hand::kRandom, Hand::kFeedback})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const TrialFigures f = judged(trialModel(1.0), hand, seed, 800);
      EXPECT_EQ(f.result, TrialResult::kRight) << seed << ": " << f.why;
      EXPECT_NEAR(f.gain[0].value, 1.0, 0.1) << seed;
      EXPECT_NEAR(f.explained.value, 1.0, 0.05) << seed;
      EXPECT_LE(f.gain[0].lower, 1.0) << seed;
      EXPECT_GE(f.gain[0].upper, 1.0) << seed;
    }
}

// On paper: of a model with g times the plant's gain 1 - (1 - g)^2 is explained, and the plant's
// gain is 1 / g of the model's.
TEST(ModelTrial, WhatAGainThatIsOffExplainsIsKnownOnPaper) {
  for (const double g : {-1.0, 0.5, 1.5, 3.0})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const TrialFigures f = judged(trialModel(g), Hand::kRandom, seed);
      EXPECT_NEAR(f.explained.value, 1.0 - (1.0 - g) * (1.0 - g), 0.2) << g << " " << seed;
      EXPECT_NEAR(f.gain[0].value, 1.0 / g, 0.1) << g << " " << seed;
    }
}

TEST(ModelTrial, WrongSignsGainsAndDelaysAreWrong) {
  for (const Hand hand : {Hand::kRandom, Hand::kFeedback})
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      EXPECT_EQ(judged(trialModel(-1.0), hand, seed).result, TrialResult::kWrong) << seed;
      EXPECT_EQ(judged(trialModel(3.0), hand, seed).result, TrialResult::kWrong) << seed;
      for (const int shift : {-2, 2}) {
        const TrialFigures f = judged(trialModel(1.0, shift), hand, seed, 800);
        EXPECT_EQ(f.result, TrialResult::kWrong) << seed << " " << shift << ": " << f.why;
      }
    }
}

TEST(ModelTrial, NothingIsKnownOfAnInputThatStandsStill) {
  const TrialFigures f = judged(trialModel(1.0), Hand::kStill, 1);
  EXPECT_EQ(f.result, TrialResult::kOpen);
  EXPECT_FALSE(f.why.empty());
}

TEST(ModelTrial, TooFewSamplesSayNothing) {
  EXPECT_EQ(judged(trialModel(-1.0), Hand::kRandom, 1, 45).result, TrialResult::kOpen);
  EXPECT_THROW(ModelTrial(trialModel(1.0), 0), InputError);
}

TEST(ModelTrial, AGapSpoilsNothing) {
  ModelTrial trial(trialModel(1.0), 400);
  Dice dice(7);
  Measurement m;
  m.outputs = Vector::Zero(1);
  m.input_applied = Vector::Zero(1);
  m.disturbances = Vector::Zero(0);
  double y = 0.0, past[5] = {};
  for (int k = 0; trial.kept() < 400; ++k) {
    m.outputs[0] = y;
    m.input_applied[0] = past[0];
    if (k % 100 == 50)
      trial.interrupt();  // the sample is lost
    else
      trial.look(m);
    for (int i = 4; i > 0; --i) past[i] = past[i - 1];
    past[0] = dice.between(-1.0, 1.0);
    y = 0.8 * y + 0.3 * past[3] + 0.1 * past[4] + 0.02 * dice.between(-1.0, 1.0);
  }
  const TrialFigures f = trial.judge(kConfidence);
  EXPECT_EQ(f.result, TrialResult::kRight) << f.why;
  EXPECT_NEAR(f.explained.value, 1.0, 0.02);
}

// y rises by 1 a sample: "it stays" is off by h, the model of a ramp is not.
TEST(HorizonErrors, OfARampAreKnownOnPaper) {
  TsModel ramp = test::oneRule(test::numbered("u", 1),
                               {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}},
                               Eigen::Vector2d(1.0, 1.0));
  HorizonErrors errors(&ramp, 5, 50);
  EXPECT_EQ(errors.horizons(), (std::vector<int>{1, 2, 4, 5}));
  Measurement m;
  m.outputs = Vector::Zero(1);
  m.input_applied = Vector::Ones(1);
  m.disturbances = Vector::Zero(0);
  for (int k = 0; k < 20; ++k) {
    m.outputs[0] = k;
    errors.look(m);
  }
  ASSERT_EQ(errors.kept(), 19);
  for (std::size_t h = 0; h < 4; ++h) {
    const int ahead = errors.horizons()[h];
    EXPECT_TRUE(ahead < 2 || std::isnan(errors.stays(0, h, ahead - 2)));
    EXPECT_EQ(errors.stays(0, h, 18), static_cast<double>(ahead * ahead));
    EXPECT_EQ(errors.model(0, h, 18), 0.0);
    EXPECT_EQ(errors.ratio(h), 0.0);
  }
}

TEST(Promise, IsBrokenBeyondTwiceTheAmplitudeAndScaledBySetpointChanges) {
  ErrorPromise promise(4, Vector::Zero(1));
  const auto add = [&](double square, double change, bool promises) {
    promise.add(Vector::Constant(1, square), change, promises);
  };
  for (int k = 0; k < 8; ++k) add(1.0, k == 0 ? 0.5 : 0.0, true);
  EXPECT_EQ(promise.broken(), -1);
  for (int k = 0; k < 4; ++k) add(4.0, 0.0, false);
  EXPECT_EQ(promise.broken(), -1);  // 4 times the squares
  for (int k = 0; k < 4; ++k) add(4.1, 0.0, false);
  EXPECT_EQ(promise.broken(), 0);
  add(4.1, 1.0, false);  // a setpoint change twice as large allows four times more
  EXPECT_EQ(promise.broken(), -1);
}

}  // namespace supervision_model_trial_test
}  // namespace fpc
