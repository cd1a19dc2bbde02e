// Medians and quantiles as the books have them, and the distributions behind intervals.
#include "base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/types.hpp"

namespace fpc {
namespace base_statistics_test {

TEST(Statistics, QuantilesAreJoinedBetweenValuesInWhateverOrderTheyCome) {
  EXPECT_EQ(quantile({4, 2, 3, 1}, 0.5), 2.5);
  EXPECT_EQ(quantile({1, 2, 3, 4}, 0.25), 1.75);
  EXPECT_EQ(quantile({5}, 0.9), 5.0);
  EXPECT_EQ(quantile({3, 1, 2}, 0.0), 1.0);
  EXPECT_EQ(quantile({3, 1, 2}, 1.0), 3.0);
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_EQ(median({1.0, kInfinity, kInfinity}), kInfinity) << "a run that failed is the worst";
  EXPECT_EQ(median({kInfinity, kInfinity}), kInfinity);
}

TEST(Statistics, DistributionsHaveTheirTabulatedValues) {
  EXPECT_EQ(normalBound(0.0), 0.0);
  EXPECT_NEAR(normalBound(0.95), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normalBound(0.9973002039367398), 3.0, 1e-12);
  EXPECT_NEAR(binomialAtMost(1, 10, 0.5), 11.0 / 1024.0, 1e-15);
  EXPECT_NEAR(binomialAtMost(0, 5, 0.3), 0.16807, 1e-15);
  EXPECT_EQ(binomialAtMost(7, 7, 0.3), 1.0);
}

}  // namespace base_statistics_test
}  // namespace fpc
