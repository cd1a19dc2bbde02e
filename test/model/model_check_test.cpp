#include "model/model_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "identification/model_fixture.hpp"

namespace fpc {
namespace fuzzy_model_check_test {

Measurement at(double y, double u) {
  Measurement m;
  m.outputs = Vector::Constant(1, y);
  m.input_applied = Vector::Constant(1, u);
  return m;
}

/// y(k+1) = a y + b y(k-1) + u(k-2), with a and b of two rules that change over at y = 0.
TsModel twoRules(double a1, double b1, double a2, double b2) {
  TsModel model;
  model.name = "two";
  model.sample_time_s = 1.0;
  model.outputs = {test::signal("y")};
  model.inputs = {test::signal("u")};
  model.submodels.resize(1);
  OutputModel& y = model.submodels[0];
  y.antecedents = {{SignalKind::kOutput, 0, 0}};
  y.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 0, 1}, {SignalKind::kInput, 0, 2}};
  y.rules = {{{{MembershipShape::kTriangular, {-1e3, -1.0, 1.0}}},
              (Vector(3) << a1, b1, 1.0).finished(),
              0.0,
              0},
             {{{MembershipShape::kTriangular, {-1.0, 1.0, 1e3}}},
              (Vector(3) << a2, b2, 1.0).finished(),
              0.0,
              0}};
  return model;
}

TEST(ModelCheck, WhatNobodyMeasuresHasNoPole) {
  TsModel model = twoRules(0.9, 0.0, 0.9, 0.0);
  model.unmeasured = {test::signal("w")};
  model.submodels[0].regressors.push_back({SignalKind::kUnmeasured, 0, 0});
  for (Rule& rule : model.submodels[0].rules)
    rule.coefficients = (Vector(4) << 0.9, 0.0, 1.0, 0.5).finished();
  EXPECT_NEAR(largestPole(model, at(-1.0, 0.0)), 0.9, 1e-9);
}

TEST(ModelCheck, PolesAreThoseOfTheRulesThatFire) {
  const TsModel model = twoRules(0.9, 0.0, 1.5, 0.0);
  EXPECT_NEAR(largestPole(model, at(-1.0, 0.0)), 0.9, 1e-9);
  EXPECT_NEAR(largestPole(model, at(1.0, 0.0)), 1.5, 1e-9);
  EXPECT_NEAR(largestPole(model, at(0.0, 0.0)), 1.2, 1e-9);  // half of each
}

TEST(ModelCheck, ComplexPolesCountWithTheirModulus) {
  const TsModel model = twoRules(0.0, -1.21, 0.0, -0.25);  // +-1.1 i, +-0.5 i
  EXPECT_NEAR(largestPole(model, at(-1.0, 0.0)), 1.1, 1e-9);
  EXPECT_NEAR(largestPole(model, at(1.0, 0.0)), 0.5, 1e-9);
}

TEST(ModelCheck, TheLimitItselfIsAllowedAndWhatIsBeyondIsNamed) {
  EXPECT_NO_THROW(requireStable(twoRules(1.0, 0.0, 1.0, 0.0), at(0.0, 0.0), 1.0));  // an integrator
  const TsModel unstable = twoRules(1.01, 0.0, 1.01, 0.0);
  EXPECT_NO_THROW(requireStable(unstable, at(0.0, 0.0), 1.02));
  EXPECT_NO_THROW(requireStable(unstable, at(0.0, 0.0), std::numeric_limits<double>::infinity()));
  try {
    requireStable(unstable, at(0.0, 0.0), 1.0);
    FAIL() << "an unstable model passed";
  } catch (const InputError& error) {
    const std::string words = error.what();
    EXPECT_NE(words.find("model 'two'"), std::string::npos) << words;
    EXPECT_NE(words.find("model.max_pole 1, got 1.01"), std::string::npos) << words;
  }
}

TEST(ModelCheck, CoupledOutputsAreJudgedTogether) {
  TsModel model = twoRules(0.0, 0.0, 0.0, 0.0);
  model.outputs = {test::signal("y"), test::signal("z")};
  OutputModel own;
  own.regressors = {{SignalKind::kOutput, 1, 0}};
  own.rules = {{{}, Vector::Constant(1, 2.0), 0.0, 0}};
  model.submodels[0] = own;  // y+ = 2 z
  own.regressors = {{SignalKind::kOutput, 0, 0}};
  model.submodels.push_back(own);  // z+ = 2 y: poles +-2, although neither depends on itself
  Measurement m = at(0.0, 0.0);
  m.outputs = Vector::Zero(2);
  EXPECT_NEAR(largestPole(model, m), 2.0, 1e-9);
}

TEST(ModelCheck, CoefficientsBeyondAllNumbersAreNotStable) {
  EXPECT_THROW(requireStable(twoRules(1e308, 1e308, 1e308, 1e308), at(0.0, 0.0), 1e300),
               InputError);
}

}  // namespace fuzzy_model_check_test
}  // namespace fpc
