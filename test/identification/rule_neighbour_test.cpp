// Which rule stands in for one without data, on rules one can place by hand.
#include "identification/rule_neighbour.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace fuzzy_rule_neighbour_test {

Rule bell(double centre) {
  Rule rule;
  rule.antecedents = {{MembershipShape::kGaussian, {centre, 1.0}}};
  return rule;
}

Rule ellipsoid(double first, double second) {
  Rule rule;
  rule.multivariate =
      MultivariateMembership{Eigen::Vector2d(first, second), Matrix::Identity(2, 2)};
  return rule;
}

OutputModel of(std::vector<Rule> rules, int variables) {
  OutputModel model;
  for (int i = 0; i < variables; ++i) model.antecedents.push_back({SignalKind::kOutput, i, 0});
  model.rules = std::move(rules);
  return model;
}

std::vector<RuleFit> fitted(std::size_t n, std::vector<std::size_t> scarce) {
  std::vector<RuleFit> fits(n);
  for (const std::size_t i : scarce) fits[i].status = RuleStatus::kBorrowed;
  return fits;
}

TEST(RuleNeighbour, IsTheFittedRuleWithTheNearestCentre) {
  const OutputModel model = of({bell(0.0), bell(4.0), bell(5.5), bell(10.0)}, 1);
  EXPECT_EQ(nearestFitted(model, fitted(4, {1}), 1), 2);
  EXPECT_EQ(nearestFitted(model, fitted(4, {1, 2}), 1), 0);
  EXPECT_EQ(nearestFitted(model, fitted(4, {0, 1, 2, 3}), 1), -1);
}

TEST(RuleNeighbour, OfEllipsoidsIsTheOneWithTheNearestCentre) {
  const OutputModel model = of({ellipsoid(0.0, 0.0), ellipsoid(1.0, 1.0), ellipsoid(3.0, 0.0)}, 2);
  EXPECT_EQ(nearestFitted(model, fitted(3, {0}), 0), 2) << "1/1 of the spans 3/1 away against 3/0";
  EXPECT_EQ(nearestFitted(model, fitted(3, {0, 2}), 0), 1);
}

TEST(RuleNeighbour, MeasuresEachVariableByTheSpanOfItsCentres) {
  // By raw numbers the second variable would not count at all.
  const OutputModel model = of(
      {ellipsoid(0.0, 0.0), ellipsoid(300.0, 0.0), ellipsoid(100.0, 0.9), ellipsoid(1000.0, 1.0)},
      2);
  EXPECT_EQ(nearestFitted(model, fitted(4, {0}), 0), 1);
}

TEST(RuleNeighbour, OfAnotherOperatingModeIsNone) {
  const auto mode = [](double value) {
    return Membership{MembershipShape::kTrapezoidal, {value, value, value, value}};
  };
  OutputModel model = of({bell(0.0), bell(1.0), bell(9.0)}, 2);
  model.rules[0].antecedents.push_back(mode(0.0));
  model.rules[1].antecedents.push_back(mode(1.0));
  model.rules[2].antecedents.push_back(mode(0.0));
  EXPECT_EQ(nearestFitted(model, fitted(3, {0}), 0), 2);
  EXPECT_EQ(nearestFitted(model, fitted(3, {0, 2}), 0), -1);
}

}  // namespace fuzzy_rule_neighbour_test
}  // namespace fpc
