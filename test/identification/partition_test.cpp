#include "identification/partition.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fpc {
namespace fuzzy_partition_test {

const Vector kValues = Vector::LinSpaced(401, -2.0, 2.0);

TEST(Partition, AGaussianProjectionHasTheWeightedMeanAndDeviation) {
  Vector memberships = Vector::Zero(401);
  memberships[100] = 1.0;  // at -1
  memberships[300] = 1.0;  // at +1
  const Membership set = projectCluster(kValues, memberships, MembershipShape::kGaussian, 2.0, 1.0);
  EXPECT_NEAR(set.parameters[0], 0.0, 1e-12);
  EXPECT_NEAR(set.parameters[1], 1.0, 1e-12);
  EXPECT_NEAR(
      projectCluster(kValues, memberships, MembershipShape::kGaussian, 2.0, 0.5).parameters[1], 0.5,
      1e-12);
}

TEST(Partition, AnExponentialProjectionFollowsShouldersAndFlanks) {
  const Membership truth{MembershipShape::kExponential, {-1.5, -0.2, 0.4, 1.4}};
  Vector memberships(401);
  for (Eigen::Index k = 0; k < 401; ++k) memberships[k] = std::exp(truth.logDegree(kValues[k]));
  const Membership set =
      projectCluster(kValues, memberships, MembershipShape::kExponential, 2.0, 1.0);
  set.validate("set");
  for (Eigen::Index k = 0; k < 401; ++k)
    EXPECT_NEAR(std::exp(set.logDegree(kValues[k])), memberships[k], 0.2) << kValues[k];
}

TEST(Partition, AOneSampleClusterStillGetsAUsableSet) {
  Vector memberships = Vector::Zero(401);
  memberships[7] = 1.0;
  for (const auto shape : {MembershipShape::kGaussian, MembershipShape::kExponential}) {
    const Membership set = projectCluster(kValues, memberships, shape, 2.0, 1.0);
    EXPECT_NO_THROW(set.validate("set"));
    EXPECT_EQ(set.logDegree(kValues[7]), 0.0);
  }
}

TEST(Partition, AGridHoldsEveryCombination) {
  const Membership a{MembershipShape::kGaussian, {0.0, 1.0}},
      b{MembershipShape::kGaussian, {1.0, 1.0}};
  const auto rules = gridRules({{a, b}, {a}, {a, b}}, 2);
  ASSERT_EQ(rules.size(), 4U);
  EXPECT_EQ(rules[1].antecedents[0], a);
  EXPECT_EQ(rules[1].antecedents[2], b);
  EXPECT_EQ(rules[2].antecedents[0], b);
  EXPECT_EQ(rules[3].coefficients.size(), 2);
}

TEST(Partition, ScalingCentersColumnsAndLeavesConstantOnesAlone) {
  Matrix values(3, 2);
  values << 1.0, 5.0, 2.0, 5.0, 3.0, 5.0;
  const Matrix scaled = columnScaling(values, Scaling::kDeviation).apply(values);
  EXPECT_NEAR(scaled.col(0).mean(), 0.0, 1e-15);
  EXPECT_NEAR(scaled.col(0).squaredNorm(), 3.0, 1e-14);
  EXPECT_EQ(scaled.col(1).norm(), 0.0);
  EXPECT_EQ(columnScaling(values, Scaling::kRange).apply(values)(2, 0), 1.0);
  EXPECT_EQ(columnScaling(values, Scaling::kNone).apply(values), values);
}

}  // namespace fuzzy_partition_test
}  // namespace fpc
