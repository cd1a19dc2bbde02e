// Whether an interval holds fewer values than chance explains.
#include "identification/interval_coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/random.hpp"
#include "identification/identified_model.hpp"

namespace fpc {
namespace fuzzy_interval_coverage_test {

using Eigen::Index;

/// Unit variance, correlation pole^lag.
Vector errors(Index n, double pole, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Vector e(n);
  double last = standardNormal(random);
  for (Index k = 0; k < n; ++k) {
    e[k] = last;
    last = pole * last + std::sqrt(1.0 - pole * pole) * standardNormal(random);
  }
  return e;
}

bool isLow(const Vector& e, double width) {
  return coverage(e, Vector::Zero(e.size()), width) < leastCoverage(independentCount(e), 95.0);
}

TEST(IntervalCoverage, LeastShareOnPaper) {
  // 3 values: none inside has probability 0.05^3 = 1.25e-4, at most one 0.00725
  EXPECT_NEAR(leastCoverage(3.0, 95.0), 100.0 / 3.0, 1e-9);
  // 2 values: none inside has probability 0.0025
  EXPECT_EQ(leastCoverage(2.0, 95.0), 0.0);
  EXPECT_EQ(leastCoverage(0.0, 95.0), 0.0);
  // 10 fair coins: no head has probability 0.00098, at most one 0.011
  EXPECT_NEAR(leastCoverage(10.0, 50.0), 10.0, 1e-9);
  // many: 3.09 deviations of the binomial distribution
  EXPECT_NEAR(leastCoverage(10000.0, 95.0), 95.0 - 3.09 * 0.2179, 0.05);
}

TEST(IntervalCoverage, CountsIndependentErrors) {
  EXPECT_EQ(independentCount(Vector()), 0.0);
  EXPECT_EQ(independentCount(Vector::Constant(7, 2.0)), 7.0);
  const double white = independentCount(errors(4000, 0.0, 1));
  EXPECT_GT(white, 3000.0);
  EXPECT_LE(white, 4000.0);
  // n (1 - a) / (1 + a)
  EXPECT_NEAR(independentCount(errors(40000, 0.9, 2)), 40000.0 / 19.0, 400.0);
  Vector gaps = errors(4000, 0.0, 3);
  for (Index k = 0; k < gaps.size(); k += 2) gaps[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_LE(independentCount(gaps), 2000.0);
  EXPECT_GT(independentCount(gaps), 1500.0);
}

TEST(IntervalCoverage, ChanceIsHardlyEverBlamed) {
  for (const double pole : {0.0, 0.9, 0.97}) {
    int blamed = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed)
      blamed += isLow(errors(400, pole, seed), 1.96) ? 1 : 0;
    EXPECT_LE(blamed, 6) << pole;
  }
}

TEST(IntervalCoverage, NarrowIntervalsAndOffsetsAreSeen) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    EXPECT_TRUE(isLow(errors(400, 0.0, seed), 1.3)) << seed;
    EXPECT_TRUE(isLow(errors(400, 0.9, seed), 0.6)) << seed;
    const Vector off = errors(400, 0.0, seed).array() + 2.0;
    EXPECT_TRUE(isLow(off, 1.96)) << seed;
  }
}

}  // namespace fuzzy_interval_coverage_test
}  // namespace fpc
