// Medians and quantiles beside a full sort.
#include "base/order_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fmbpc/base/types.hpp"

namespace fpc {
namespace base_order_statistics_test {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

TEST(OrderStatistics, MediansOnPaper) {
  EXPECT_EQ(upperMedian({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(upperMedian({4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(sampleQuantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(sampleQuantile({4.0, 1.0, 3.0, 2.0, 0.0}, 0.25), 1.0);
  EXPECT_EQ(sampleQuantile({4.0, 1.0, 3.0}, 0.0), 1.0);
  EXPECT_EQ(sampleQuantile({4.0, 1.0, 3.0}, 1.0), 4.0);
  EXPECT_EQ(upperMedian({7.0}), 7.0);
}

TEST(OrderStatistics, NothingIsNotANumber) {
  EXPECT_TRUE(std::isnan(upperMedian({})));
  EXPECT_TRUE(std::isnan(sampleQuantile({}, 0.5)));
  EXPECT_TRUE(std::isnan(orderStatistic({1.0, 2.0}, 2)));
}

TEST(OrderStatistics, NotANumberStandsBehindAllNumbers) {
  const std::vector<double> values{kNotANumber, 2.0, kInfinity, kNotANumber, -kInfinity, 1.0};
  EXPECT_EQ(orderStatistic(values, 0), -kInfinity);
  EXPECT_EQ(orderStatistic(values, 1), 1.0);
  EXPECT_EQ(orderStatistic(values, 2), 2.0);
  EXPECT_EQ(orderStatistic(values, 3), kInfinity);
  EXPECT_TRUE(std::isnan(orderStatistic(values, 4)));
  EXPECT_TRUE(std::isnan(orderStatistic(values, 5)));
}

TEST(OrderStatistics, EveryPlaceIsThatOfASort) {
  std::mt19937_64 random(5);
  for (std::size_t n = 1; n <= 60; ++n) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i) values.push_back(static_cast<double>(random() % 20));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(orderStatistic(values, i), sorted[i]);
    EXPECT_EQ(upperMedian(values), sorted[n / 2]);
  }
}

}  // namespace base_order_statistics_test
}  // namespace fpc
