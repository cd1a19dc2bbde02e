#include "fmbpc/model/membership.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {
namespace fuzzy_membership_test {

const double kMinusInfinity = -kInfinity;

TEST(Membership, ExponentialIsOneOnItsShouldersAndSevenNepersDownAtItsFeet) {
  const Membership set{MembershipShape::kExponential, {10.0, 20.0, 30.0, 50.0}};
  for (const double z : {20.0, 25.0, 30.0}) EXPECT_EQ(set.logDegree(z), 0.0);
  EXPECT_DOUBLE_EQ(set.logDegree(10.0), -7.0);
  EXPECT_DOUBLE_EQ(set.logDegree(50.0), -7.0);
  EXPECT_DOUBLE_EQ(set.logDegree(15.0), -1.75);
  EXPECT_DOUBLE_EQ(set.logDegree(0.0), -28.0);
}

TEST(Membership, ZeroWidthIsACrispEdge) {
  const Membership set{MembershipShape::kExponential, {10.0, 10.0, 30.0, 30.0}};
  EXPECT_EQ(set.logDegree(10.0), 0.0);
  EXPECT_EQ(set.logDegree(30.0), 0.0);
  EXPECT_EQ(set.logDegree(std::nextafter(10.0, 0.0)), kMinusInfinity);
  EXPECT_EQ(set.logDegree(std::nextafter(30.0, 40.0)), kMinusInfinity);
}

TEST(Membership, GaussianFollowsItsFormulaFarIntoTheTail) {
  const Membership set{MembershipShape::kGaussian, {5.0, 2.0}};
  EXPECT_EQ(set.logDegree(5.0), 0.0);
  EXPECT_DOUBLE_EQ(set.logDegree(7.0), -0.5);
  EXPECT_DOUBLE_EQ(set.logDegree(2005.0), -500000.0);
}

TEST(Membership, LinearFlanksAreLinear) {
  const Membership triangle{MembershipShape::kTriangular, {0.0, 1.0, 3.0}};
  EXPECT_DOUBLE_EQ(std::exp(triangle.logDegree(0.25)), 0.25);
  EXPECT_DOUBLE_EQ(std::exp(triangle.logDegree(2.5)), 0.25);
  EXPECT_EQ(triangle.logDegree(1.0), 0.0);
  EXPECT_EQ(triangle.logDegree(0.0), kMinusInfinity);
  EXPECT_EQ(triangle.logDegree(3.5), kMinusInfinity);
  const Membership trapezoid{MembershipShape::kTrapezoidal, {0.0, 1.0, 2.0, 4.0}};
  EXPECT_EQ(trapezoid.logDegree(1.5), 0.0);
  EXPECT_DOUBLE_EQ(std::exp(trapezoid.logDegree(3.0)), 0.5);
}

TEST(Membership, NeverGivesNaNForFiniteValues) {
  const double largest = std::numeric_limits<double>::max();
  for (const Membership& set : {Membership{MembershipShape::kExponential, {-1.0, 0.0, 0.0, 1e-300}},
                                Membership{MembershipShape::kExponential, {0.0, 0.0, 0.0, 0.0}},
                                Membership{MembershipShape::kGaussian, {1e300, 1e-300}},
                                Membership{MembershipShape::kTriangular, {0.0, 0.0, 1e-320}}})
    for (const double z : {-largest, -1.0, 0.0, 1e-310, 1.0, largest}) {
      EXPECT_FALSE(std::isnan(set.logDegree(z))) << name(set.shape) << " at " << z;
      EXPECT_LE(set.logDegree(z), 0.0);
      EXPECT_GE(set.distance(z), 0.0);
    }
}

TEST(Membership, DistanceCountsWidthsBeyondTheFeet) {
  const Membership set{MembershipShape::kExponential, {10.0, 10.0, 20.0, 30.0}};
  EXPECT_EQ(set.distance(10.0), 0.0);
  EXPECT_EQ(set.distance(30.0), 0.0);
  EXPECT_DOUBLE_EQ(set.distance(0.0), 0.5);
  EXPECT_DOUBLE_EQ(set.distance(70.0), 2.0);
  const Membership point{MembershipShape::kExponential, {5.0, 5.0, 5.0, 5.0}};
  EXPECT_DOUBLE_EQ(point.distance(8.0), 3.0);
}

TEST(Membership, NamesAndShapesBelongTogether) {
  for (const char* text : {"exponential", "gaussian", "triangular", "trapezoidal"})
    EXPECT_EQ(name(membershipShape(text)), text);
  EXPECT_THROW(membershipShape("bell"), InputError);
}

TEST(Membership, WrongParametersAreRefusedByName) {
  const auto refused = [](MembershipShape shape, std::vector<double> parameters) {
    try {
      Membership{shape, std::move(parameters)}.validate("the set");
    } catch (const InputError& e) {
      return std::string(e.what()).find("the set") == 0;
    }
    return false;
  };
  EXPECT_TRUE(refused(MembershipShape::kExponential, {1.0, 2.0, 3.0}));
  EXPECT_TRUE(refused(MembershipShape::kExponential, {1.0, 3.0, 2.0, 4.0}));
  EXPECT_TRUE(refused(MembershipShape::kTriangular, {1.0, 2.0, std::nan("")}));
  EXPECT_TRUE(refused(MembershipShape::kGaussian, {1.0, 0.0}));
  EXPECT_TRUE(refused(MembershipShape::kTrapezoidal, {-1e308, 0.0, 0.0, 1e308}));
  EXPECT_NO_THROW(
      (Membership{MembershipShape::kExponential, {1.0, 1.0, 1.0, 1.0}}.validate("the set")));
}

}  // namespace fuzzy_membership_test
}  // namespace fpc
