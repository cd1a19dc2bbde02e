#include "fmbpc/fuzzy/gain_sign.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "fuzzy/model_fixture.hpp"

namespace fpc {
namespace {

/// y(k+1) = a y + b1 u1 + b2 u2: gains b / (1 - a).
TsModel model(double a, double b1, double b2) {
  TsModel m;
  m.name = "new";
  m.sample_time_s = 1.0;
  m.outputs = {test::signal("y")};
  m.inputs = {test::signal("u1"), test::signal("u2")};
  m.submodels.resize(1);
  OutputModel& y = m.submodels[0];
  y.antecedents = {{SignalKind::kOutput, 0, 0}};
  y.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}, {SignalKind::kInput, 1, 0}};
  y.rules = {{{{MembershipShape::kTriangular, {-1e3, 0.0, 1e3}}},
              (Vector(3) << a, b1, b2).finished(),
              0.0,
              0}};
  return m;
}

Measurement rest() {
  Measurement m;
  m.outputs = Vector::Zero(1);
  m.input_applied = Vector::Zero(2);
  return m;
}

TEST(GainSign, GainsAreThoseOfPaper) {
  const Matrix gains = stepGains(model(0.5, 2.0, -1.0), rest());
  EXPECT_NEAR(gains(0, 0), 4.0, 1e-12);
  EXPECT_NEAR(gains(0, 1), -2.0, 1e-12);
  EXPECT_EQ(stepGains(model(1.0, 2.0, 0.0), rest())(0, 0), 2.0 * kGainSamples);  // an integrator
}

TEST(GainSign, AGainThatTurnsRoundIsRefusedByName) {
  EXPECT_NO_THROW(requireSameGainSigns(model(0.5, 2.0, 1.0), model(0.8, 0.1, 0.1), rest()));
  try {
    requireSameGainSigns(model(0.5, 2.0, 1.0), model(0.5, -2.0, 1.0), rest());
    FAIL() << "nothing was thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("from u1 to y"), std::string::npos) << error.what();
  }
}

TEST(GainSign, SmallGainsMayTurnAndUnstableModelsAreNotJudged) {
  EXPECT_NO_THROW(requireSameGainSigns(model(0.5, 2.0, 0.1), model(0.5, 2.0, -0.1), rest()));
  EXPECT_NO_THROW(requireSameGainSigns(model(2.0, 2.0, 1.0), model(0.5, -2.0, 1.0), rest()));
}

}  // namespace
}  // namespace fpc
