#include "base/no_value.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {
namespace base_no_value_test {

TEST(NoValue, IsNoNumberAndSaysWhy) {
  for (const NoValue why : {NoValue::kNoNumber, NoValue::kStale, NoValue::kMissing}) {
    EXPECT_TRUE(std::isnan(noValue(why)));
    EXPECT_EQ(whyNoValue(noValue(why)), why);
  }
}

TEST(NoValue, TravelsInVectorsAndArrays) {
  const Vector copied = Vector::Constant(3, noValue(NoValue::kStale));
  const std::vector<double> again(copied.data(), copied.data() + copied.size());
  EXPECT_EQ(whyNoValue(again[2]), NoValue::kStale);
}

TEST(NoValue, NobodyElsesNaNHasAReason) {
  for (const double value : {std::nan(""), std::nan("1"), std::nan("2"), -std::nan(""), 1.0,
                             std::numeric_limits<double>::infinity()})
    EXPECT_EQ(whyNoValue(value), NoValue::kNoNumber);
}

}  // namespace base_no_value_test
}  // namespace fpc
