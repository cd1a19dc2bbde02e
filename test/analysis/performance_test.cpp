#include "analysis/performance.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_performance_test {

Vector of(std::initializer_list<double> values) {
  Vector v(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double value : values) v[i++] = value;
  return v;
}

// e = 1, -2, 3, 0 at t = 0, 0.5, 1, 1.5 h;  y_r - y = 0, -1, 1, 2
TEST(OutputIndices, AreTheSumsDoneByHand) {
  const OutputIndices i =
      outputIndices(of({9, 12, 7, 10}), of({10, 10, 10, 10}), of({9, 11, 8, 12}), 0.5);
  EXPECT_DOUBLE_EQ(i.ise, 1 + 4 + 9);
  EXPECT_DOUBLE_EQ(i.iae, 1 + 2 + 3);
  EXPECT_DOUBLE_EQ(i.itae, 0.5 * 2 + 1.0 * 3);
  EXPECT_DOUBLE_EQ(i.itse, 0.5 * 4 + 1.0 * 9);
  EXPECT_DOUBLE_EQ(i.rmse, std::sqrt(14.0 / 4.0));
  EXPECT_DOUBLE_EQ(i.ise_reference, 0 + 1 + 1 + 4);
}

TEST(OutputIndices, SampleTimeChangesOnlyTheTimeWeightedOnes) {
  const Vector y = of({1, 2, 4}), setpoint = of({0, 0, 0});
  const OutputIndices slow = outputIndices(y, setpoint, y, 1.0);
  const OutputIndices fast = outputIndices(y, setpoint, y, 0.2);
  EXPECT_EQ(slow.ise, fast.ise);
  EXPECT_EQ(slow.iae, fast.iae);
  EXPECT_DOUBLE_EQ(fast.itae, 0.2 * slow.itae);
  EXPECT_DOUBLE_EQ(fast.itse, 0.2 * slow.itse);
  EXPECT_EQ(slow.ise_reference, 0.0);
}

TEST(OutputIndices, MissingSampleIsNotLeftOutInSilence) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(outputIndices(of({1, nan}), of({1, 1}), of({1, 1}), 1.0).ise));
}

TEST(OutputIndices, BadSizesThrow) {
  EXPECT_THROW(outputIndices(of({1, 2}), of({1}), of({1, 2}), 1.0), InputError);
  EXPECT_THROW(outputIndices(of({1, 2}), of({1, 2}), of({1}), 1.0), InputError);
  EXPECT_THROW(outputIndices(of({1}), of({1}), of({1}), 0.0), InputError);
}

TEST(OutputIndices, NoSamplesGiveZeros) {
  const OutputIndices i = outputIndices(Vector(), Vector(), Vector(), 1.0);
  EXPECT_EQ(i.ise, 0.0);
  EXPECT_EQ(i.rmse, 0.0);
}

// Moves from 570: 30, -100, 0, 250
TEST(InputIndices, CountTheFirstMoveToo) {
  const InputIndices i = inputIndices(of({600, 500, 500, 750}), 570.0);
  EXPECT_EQ(i.min, 500.0);
  EXPECT_EQ(i.max, 750.0);
  EXPECT_DOUBLE_EQ(i.mean_abs_move, (30.0 + 100.0 + 0.0 + 250.0) / 4.0);
  EXPECT_EQ(i.travel, 380.0);
  EXPECT_EQ(i.switches, 3U);
}

TEST(InputIndices, WithoutSamplesTheInputStayed) {
  const InputIndices i = inputIndices(Vector(), 570.0);
  EXPECT_EQ(i.min, 570.0);
  EXPECT_EQ(i.max, 570.0);
  EXPECT_EQ(i.mean_abs_move, 0.0);
}

}  // namespace analysis_performance_test
}  // namespace fpc
