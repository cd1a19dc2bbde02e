// Rests of fuzzy models on models whose rests are known on paper.
#include "analysis/fuzzy_equilibrium.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "identification/multivariate_fixture.hpp"

namespace fpc {
namespace analysis_fuzzy_equilibrium_test {

/// Two rules on y, far apart and narrow: y+ = 0.5 y + b u + c around each centre.
TsModel twoBasins() {
  TsModel model;
  model.name = "two basins";
  model.sample_time_s = 1.0;
  model.outputs = {test::signal("y")};
  model.inputs = {test::signal("u")};
  model.submodels.resize(1);
  OutputModel& submodel = model.submodels[0];
  submodel.regressors = {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 0}};
  submodel.antecedents = {{SignalKind::kOutput, 0, 0}};
  for (const double centre : {-5.0, 5.0}) {
    Rule rule;
    rule.antecedents = {{MembershipShape::kGaussian, {centre, 1.0}}};
    rule.coefficients = Eigen::Vector2d(0.5, 0.1);
    rule.offset = 0.5 * centre;
    submodel.rules.push_back(rule);
  }
  return model;
}

TEST(FuzzyEquilibria, BothStableRestsAndTheOneBetweenThemAreFound) {
  for (const bool ellipsoids : {false, true}) {
    SCOPED_TRACE(ellipsoids ? "multivariate" : "one set per variable");
    const TsModel model = ellipsoids ? test::multivariate(twoBasins()) : twoBasins();
    auto rests = fuzzyEquilibria(model, Vector::Zero(1), Vector());
    std::sort(rests.begin(), rests.end(),
              [](const auto& a, const auto& b) { return a.outputs[0] < b.outputs[0]; });
    ASSERT_EQ(rests.size(), 3U);
    EXPECT_NEAR(rests[0].outputs[0], -5.0, 1e-8);
    EXPECT_NEAR(rests[1].outputs[0], 0.0, 1e-8);
    EXPECT_NEAR(rests[2].outputs[0], 5.0, 1e-8);
    for (const auto& rest : rests) EXPECT_NEAR(spectralRadius(rest.values), 0.5, 1e-9);
  }
}

TEST(FuzzyEquilibria, TheInputMovesARestByItsGain) {
  const TsModel model = test::multivariate(twoBasins());
  const auto rests = fuzzyEquilibria(model, Vector::Constant(1, 2.0), Vector());
  const auto upper = std::find_if(rests.begin(), rests.end(),
                                  [](const auto& rest) { return rest.outputs[0] > 4.0; });
  ASSERT_NE(upper, rests.end());
  EXPECT_NEAR(upper->outputs[0], 5.0 + 0.1 * 2.0 / 0.5, 1e-8);
}

TEST(UsualValue, IsTheMeanOfTheCentresOfEllipsoidsAsOfSets) {
  TsModel model = twoBasins();
  model.submodels[0].rules[0].antecedents[0].parameters[0] = -3.0;
  EXPECT_NEAR(usualValue(model, SignalKind::kOutput, 0), 1.0, 1e-12);
  EXPECT_NEAR(usualValue(test::multivariate(model), SignalKind::kOutput, 0), 1.0, 1e-12);
}

}  // namespace analysis_fuzzy_equilibrium_test
}  // namespace fpc
