#include "base/random.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace base_random_test {

TEST(Gaussian, MomentsAreThoseOfTheStandardNormal) {
  constexpr unsigned kSeed = 1;
  constexpr int kCount = 400000;
  std::mt19937_64 engine(kSeed);
  double sum = 0.0, squares = 0.0, fourth = 0.0, inside = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double n = standardNormal(engine);
    sum += n;
    squares += n * n;
    fourth += n * n * n * n;
    inside += std::abs(n) < 1.0 ? 1.0 : 0.0;
  }
  // Bounds are five standard errors.
  EXPECT_NEAR(sum / kCount, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(fourth / kCount, 3.0, 5.0 * std::sqrt(96.0 / kCount));
  EXPECT_NEAR(inside / kCount, 0.6826895, 5.0 * std::sqrt(0.2167 / kCount));
}

TEST(Gaussian, NeighboursAreIndependent) {
  std::mt19937_64 engine(2);
  constexpr int kCount = 100000;
  double products = 0.0, previous = standardNormal(engine);
  for (int i = 0; i < kCount; ++i) {
    const double n = standardNormal(engine);
    products += n * previous;
    previous = n;
  }
  EXPECT_NEAR(products / kCount, 0.0, 5.0 / std::sqrt(kCount));
}

TEST(Gaussian, UniformNumbersFillTheHalfOpenInterval) {
  std::mt19937_64 engine(3);
  double low = 1.0, high = 0.0;
  for (int i = 0; i < 100000; ++i) {
    const double v = uniform(engine);
    low = std::min(low, v);
    high = std::max(high, v);
  }
  EXPECT_GE(low, 0.0);
  EXPECT_LT(low, 1e-4);
  EXPECT_LT(high, 1.0);
  EXPECT_GT(high, 1.0 - 1e-4);
}

}  // namespace base_random_test
}  // namespace fpc
