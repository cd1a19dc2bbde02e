// Swings of an input that grow: found whatever their size and shape, told from those that shrink,
// stay, or are noise.
#include "supervision/growing_swings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace fpc {
namespace control_growing_swings_test {

/// The first sample at which they are found, -1 for none.
int found(GrowingSwings swings, int samples, const std::function<double(int)>& input) {
  for (int k = 0; k < samples; ++k)
    if (swings.add(input(k), Vector::Constant(1, -input(k)))) return k;
  return -1;
}

double wave(int k, double growth, double period) {
  return std::pow(growth, k) * std::sin(2.0 * M_PI * k / period);
}

// Half swings of 5 samples: the seventh ends at sample 32.5 and is seen a sample after its turn.
TEST(GrowingSwings, AreFoundAtTheTurnThatEndsTheLastOfThem) {
  const int at = found(GrowingSwings(6, 1), 100, [](int k) { return wave(k, 1.05, 10.0); });
  EXPECT_GE(at, 30);
  EXPECT_LE(at, 38);
}

TEST(GrowingSwings, ShiftAndScaleChangeNothing) {
  const auto grown = [](int k) { return wave(k, 1.05, 10.0); };
  const int at = found(GrowingSwings(6, 1), 100, grown);
  EXPECT_EQ(found(GrowingSwings(6, 1), 100, [&](int k) { return 8.0 - 1024.0 * grown(k); }), at);
}

TEST(GrowingSwings, ThoseThatShrinkOrStayAreNone) {
  for (const double growth : {1.0, 0.98})
    for (const double period : {4.0, 10.0, 37.0})
      EXPECT_EQ(found(GrowingSwings(6, 1), 400,
                      [&](int k) { return std::round(1e6 * wave(k, growth, period)); }),
                -1)
          << growth << " " << period;
}

TEST(GrowingSwings, NoiseAtRestIsNone) {
  std::mt19937 engine(7);
  std::normal_distribution<double> noise;
  int runs = 0;
  for (int run = 0; run < 100; ++run)
    runs += found(GrowingSwings(8, 1), 1000, [&](int) { return noise(engine); }) >= 0 ? 1 : 0;
  EXPECT_LE(runs, 2);
}

TEST(GrowingSwings, SmallTurnsOnTheWayAndLostValuesChangeNothing) {
  const int at = found(GrowingSwings(6, 1), 200, [](int k) {
    if (k % 13 == 5) return std::nan("");
    return wave(k, 1.03, 20.0) + (k % 2 == 0 ? 0.1 : 0.0);
  });
  EXPECT_GE(at, 60);
  EXPECT_LE(at, 90);
}

TEST(GrowingSwings, WithoutANumberNoneAreLookedFor) {
  EXPECT_EQ(found(GrowingSwings(0, 1), 200, [](int k) { return wave(k, 1.1, 8.0); }), -1);
}

}  // namespace control_growing_swings_test
}  // namespace fpc
