// Rise, settling, overshoot and offset of responses whose indices are known on paper.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/performance.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_step_indices_test {

Vector vector(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

TEST(StepIndices, OfAFirstOrderLagAreLogarithmsOfItsTimeConstant) {
  constexpr double kTau = 2.0, kTs = 0.01;
  constexpr Eigen::Index kN = 4000;
  Vector y(kN + 1);
  for (Eigen::Index k = 0; k <= kN; ++k)
    y[k] = 5.0 + 3.0 * (1.0 - std::exp(-static_cast<double>(k) * kTs / kTau));
  const auto steps = stepIndices(y, Vector::Constant(kN + 1, 8.0), kTs);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(steps[0].rise, kTau * std::log(9.0), 1e-4);
  EXPECT_NEAR(steps[0].settling, kTau * std::log(50.0), 1e-4);
  EXPECT_EQ(steps[0].overshoot, 0.0);
  EXPECT_LT(steps[0].offset, 1e-5);
}

TEST(StepIndices, CountOvershootBandAndTheLastTenthDownwardsAsUpwards) {
  // 21 samples: from 10 to 6; z = 0, 0.5, 1.25, 0.9, then 1.01, and 1.005 over the last tenth (2).
  Vector y = Vector::Constant(21, 10.0 - 4.0 * 1.01);
  y[0] = 10.0;
  y[1] = 8.0;
  y[2] = 5.0;
  y[3] = 6.4;
  y.tail(2).setConstant(10.0 - 4.0 * 1.005);
  const auto steps = stepIndices(y, Vector::Constant(21, 6.0), 0.5);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(steps[0].overshoot, 25.0, 1e-12);
  EXPECT_NEAR(steps[0].offset, 0.5, 1e-12);
  EXPECT_NEAR(steps[0].rise, 0.5 * ((1.0 + 0.4 / 0.75) - 0.2), 1e-12);
  EXPECT_NEAR(steps[0].settling, 0.5 * (3.0 + (0.98 - 0.9) / (1.01 - 0.9)), 1e-12);
  EXPECT_NEAR(steps[0].cost(), 5.0 + 25.0 + steps[0].rise + steps[0].settling, 1e-12);
}

TEST(StepIndices, SeparateTheStepsOfASchedule) {
  const Vector setpoint = vector({1, 1, 1, 1, 3, 3, 3, 3, 2, 2, 2});
  const Vector y = vector({1, 1, 1, 1, 1, 3, 3, 3, 3, 2, 2});
  const auto steps = stepIndices(y, setpoint, 1.0);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].first, 4);
  EXPECT_EQ(steps[0].last, 8);
  EXPECT_EQ(steps[0].to, 3.0);
  EXPECT_EQ(steps[1].from, 3.0);
  EXPECT_EQ(steps[1].last, 10);
  for (const auto& step : steps) {
    EXPECT_NEAR(step.rise, 0.8, 1e-12);
    EXPECT_NEAR(step.settling, 0.98, 1e-12);
    EXPECT_EQ(step.offset, 0.0);
  }
}

TEST(StepIndices, WhatNeverHappensTakesTheWholeStep) {
  const auto steps = stepIndices(Vector::Zero(11), vector({0, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}), 2.0);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].rise, 18.0);
  EXPECT_EQ(steps[0].settling, 18.0);
  EXPECT_EQ(steps[0].offset, 100.0);
}

TEST(StepIndices, ARampIsOneStepAndAHairIsNone) {
  const Vector setpoint = vector({0, 0, 1, 2, 3, 3, 3, 3.01, 3.01});
  const auto steps = stepIndices(Vector::Zero(9), setpoint, 1.0);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].from, 0.0);
  EXPECT_EQ(steps[0].to, 3.0);
  EXPECT_EQ(steps[0].last, 8);
}

TEST(StepIndices, AreNotANumberWhereTheOutputIsNot) {
  Vector y = Vector::Zero(6);
  y[4] = std::numeric_limits<double>::quiet_NaN();
  const auto steps = stepIndices(y, vector({0, 1, 1, 2, 2, 2}), 1.0);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_TRUE(std::isfinite(steps[0].cost()));
  EXPECT_TRUE(std::isnan(steps[1].cost()));
}

TEST(StepIndices, OfNothingAreNoneAndMistakesAreNamed) {
  EXPECT_TRUE(stepIndices(Vector::Ones(5), Vector::Ones(5), 1.0).empty());
  EXPECT_TRUE(stepIndices(Vector(), Vector(), 1.0).empty());
  EXPECT_THROW(stepIndices(Vector::Ones(5), Vector::Ones(4), 1.0), InputError);
  EXPECT_THROW(stepIndices(Vector::Ones(5), Vector::Ones(5), 0.0), InputError);
  EXPECT_THROW(stepIndices(Vector::Ones(5), Vector::Ones(5), 1.0, 0.0), InputError);
}

TEST(InputIndices, EffortIsTheSumOfSquaredMovesAndEnergyOfSquaredInputs) {
  const InputIndices u = inputIndices(vector({1, 3, 2}), 0.0);
  EXPECT_EQ(u.effort, 1.0 + 4.0 + 1.0);
  EXPECT_EQ(u.energy, 1.0 + 9.0 + 4.0);
}

}  // namespace analysis_step_indices_test
}  // namespace fpc
