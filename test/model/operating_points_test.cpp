// Gains, poles, dead times and step responses of models that are known.
#include "model/operating_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fpc {
namespace model_operating_points_test {

/// y(k+1) = pole y(k) + (1 - pole) gain u(k - 3).
TsModel lag(double pole, double gain) {
  TsModel model;
  model.name = "lag";
  model.sample_time_s = 2.0;
  model.outputs = {{"y", "", 0.0, 10.0}};
  model.inputs = {{"u", "", 0.0, 10.0}};
  OutputModel submodel;
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 3}};
  submodel.rules = {{{}, (Vector(2) << pole, (1.0 - pole) * gain).finished(), 0.0, 0, {}}};
  model.submodels = {submodel};
  return model;
}

TEST(OperatingPoints, OfALagAreItsGainPoleAndTimeConstant) {
  const auto points = operatingPoints(lag(0.9, 0.8));
  ASSERT_EQ(points.size(), 3U);
  for (const auto& p : points) {
    EXPECT_TRUE(p.rests);
    EXPECT_NEAR(p.gains(0, 0), 0.8, 1e-9);
    EXPECT_NEAR(p.outputs[0], 0.8 * p.inputs[0], 1e-6);
    ASSERT_FALSE(p.poles.empty());
    EXPECT_NEAR(p.poles.front().real(), 0.9, 1e-9);
    ASSERT_FALSE(p.time_constants_s.empty());
    EXPECT_NEAR(p.time_constants_s.front(), -2.0 / std::log(0.9), 1e-6);
    EXPECT_EQ(p.steps[0](3, 0), 0.0);
    EXPECT_NEAR(p.steps[0](4, 0), 0.08, 1e-12);
    EXPECT_NEAR(p.steps[0](p.steps[0].rows() - 1, 0), 0.8, 0.01);
  }
  EXPECT_NEAR(points[1].inputs[0], 1.0, 1e-12);
  EXPECT_NEAR(points[2].inputs[0], 9.0, 1e-12);
  EXPECT_EQ(deadTimes(lag(0.9, 0.8))(0, 0), 4);
}

TEST(OperatingPoints, AnIntegratorDoesNotRestAndHasNoGain) {
  TsModel model = lag(0.9, 1.0);
  model.submodels[0].rules[0].coefficients << 1.0, 0.1;
  const auto points = operatingPoints(model, 30);
  EXPECT_FALSE(points[0].rests);
  EXPECT_TRUE(std::isinf(points[0].gains(0, 0)));
  EXPECT_NEAR(points[0].steps[0](24, 0) - points[0].steps[0](14, 0), 1.0, 1e-9);
}

TEST(OperatingPoints, OfRulesHaveTheSlopeOfTheCurveAtEachRest) {
  TsModel model = lag(0.5, 1.0);  // gain 1 where u is low, 3 where it is high
  OutputModel& s = model.submodels[0];
  s.regressors[1].lag = 0;
  s.antecedents = {{SignalKind::kInput, 0, 0}};
  s.rules = {
      {{{MembershipShape::kGaussian, {0.0, 2.0}}}, (Vector(2) << 0.5, 0.5).finished(), 0.0, 0, {}},
      {{{MembershipShape::kGaussian, {10.0, 2.0}}},
       (Vector(2) << 0.5, 1.5).finished(),
       0.0,
       0,
       {}}};
  model.outputs[0].upper = 40.0;
  const auto rest = [&](double u) {
    TsModel at = model;
    at.inputs[0].lower = u - 1.0;
    at.inputs[0].upper = u + 1.0;
    return operatingPoints(at)[0];
  };
  for (const double u : {2.0, 5.0, 8.0}) {
    const double slope = (rest(u + 1e-4).outputs[0] - rest(u - 1e-4).outputs[0]) / 2e-4;
    EXPECT_NEAR(rest(u).gains(0, 0), slope, 1e-3 * std::abs(slope)) << u;
  }
}

TEST(OperatingPoints, DeadTimesGoThroughOtherOutputs) {
  TsModel model = lag(0.9, 1.0);
  model.outputs.push_back({"z", "", 0.0, 1.0});
  OutputModel second;
  second.regressors = {{SignalKind::kOutput, 1, 0}, {SignalKind::kOutput, 0, 1}};
  second.rules = {{{}, (Vector(2) << 0.5, 0.5).finished(), 0.0, 0, {}}};
  model.submodels.push_back(second);
  EXPECT_EQ(deadTimes(model)(1, 0), 6);
  model.inputs.push_back({"v", "", 0.0, 1.0});
  EXPECT_EQ(deadTimes(model)(0, 1), -1);
}

TEST(OperatingPoints, WithoutRangesThereAreNone) {
  TsModel model = lag(0.9, 1.0);
  model.inputs[0].upper = kInfinity;
  EXPECT_TRUE(operatingPoints(model).empty());
}

}  // namespace model_operating_points_test
}  // namespace fpc
