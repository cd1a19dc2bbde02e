#include "optim/simplex_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fpc {
namespace {

double rosenbrock(const Vector& x) {
  return 100.0 * std::pow(x[1] - x[0] * x[0], 2) + std::pow(1.0 - x[0], 2);
}

TEST(SimplexSearch, FindsTheEndOfABentValley) {
  const Vector x = simplexSearch(Vector::Constant(2, -1.0), 300,
                                 [](const Vector& at, double) { return rosenbrock(at); });
  EXPECT_NEAR(x[0], 1.0, 1e-4);
  EXPECT_NEAR(x[1], 1.0, 1e-4);
}

/// Of a point that is not below the bound no more is asked.
TEST(SimplexSearch, AsksNoMoreThanWhetherAPointIsBelowTheBound) {
  const Vector start = Vector::Constant(2, -1.0);
  const auto exact = [](const Vector& at, double) { return rosenbrock(at); };
  int cut = 0;
  const auto rough = [&](const Vector& at, double least) {
    const double value = rosenbrock(at);
    if (value < least) return value;
    ++cut;
    return std::numeric_limits<double>::infinity();
  };
  const Vector x = simplexSearch(start, 120, rough);
  EXPECT_GT(cut, 10);
  EXPECT_LT(rosenbrock(x), 1e-2);
  EXPECT_LT(rosenbrock(simplexSearch(start, 120, exact)), 1e-2);
}

TEST(SimplexSearch, KeepsToItsEvaluationsAndToTheBestPoint) {
  for (const int most : {5, 20, 48}) {
    int count = 0;
    double best = std::numeric_limits<double>::infinity();
    const Vector x = simplexSearch(Vector::Constant(3, 2.0), most, [&](const Vector& at, double) {
      ++count;
      best = std::min(best, at.squaredNorm());
      return at.squaredNorm();
    });
    EXPECT_GE(count, most);
    EXPECT_LE(count, most + 4);
    EXPECT_EQ(x.squaredNorm(), best);
  }
}

/// A function without a value beyond an edge, as of a loop that is lost there.
TEST(SimplexSearch, StaysThisSideOfAnEdge) {
  const Vector x = simplexSearch(Vector::Zero(2), 150, [](const Vector& at, double) {
    return at[0] > 1.5 ? std::numeric_limits<double>::infinity()
                       : std::pow(at[0] - 2.0, 2) + std::pow(at[1] + 1.0, 2);
  });
  EXPECT_LE(x[0], 1.5);
  EXPECT_NEAR(x[0], 1.5, 1e-2);
  EXPECT_NEAR(x[1], -1.0, 5e-2);
}

}  // namespace
}  // namespace fpc
