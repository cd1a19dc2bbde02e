// Inputs that act within their sample: found in open loop, never taken for one in closed loop.
#include "identification/row_reading.hpp"
#include "identification/pair_data.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "identification/auto_identify.hpp"
#include "identification/record_remarks.hpp"

namespace fpc {
namespace identification_row_reading_test {

using Eigen::Index;

/// x(k+1) = 0.8 x(k) + 0.2 u(k + ahead); the row holds x(k) with noise and u(k).
DataSet openLoop(Index ahead, double noise, std::uint64_t seed, double colour) {
  std::mt19937_64 random(seed);
  const Index rows = 500;
  Vector u(rows + 1);
  u[0] = 0.0;
  for (Index k = 1; k <= rows; ++k)
    u[k] = colour * u[k - 1] + std::sqrt(1.0 - colour * colour) * standardNormal(random);
  Matrix values(rows, 2);
  double x = 0.0;
  for (Index k = 0; k < rows; ++k) {
    values.row(k) << x + noise * standardNormal(random), u[k];
    x = 0.8 * x + 0.2 * u[k + ahead];
  }
  return pairData(values);
}

/// A law of the same row: u(k) = gain (r(k) - y(k)) + integral.
DataSet closedLoop(double gain, double integral, double noise, std::uint64_t seed,
                   double setpoint = 1.0) {
  std::mt19937_64 random(seed);
  const Index rows = 500;
  Matrix values(rows, 2);
  double x = 0.0, sum = 0.0, r = 0.0, load = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 40 == 0) r = setpoint * standardNormal(random);
    const double y = x + noise * standardNormal(random);
    sum += integral * (r - y);
    const double u = gain * (r - y) + sum;
    values.row(k) << y, u;
    load = 0.95 * load + 0.1 * standardNormal(random);
    x = 0.8 * x + 0.2 * (u + load);
  }
  return pairData(values);
}

bool readSame(const DataSet& data) { return readRows(data, RowReading::kFound).same[0]; }

TEST(RowReading, AnInputThatActsWithinItsSampleIsFound) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const double colour : {0.0, 0.9})
      EXPECT_TRUE(readSame(openLoop(1, 0.02, seed, colour))) << seed << ", " << colour;
}

TEST(RowReading, AnInputThatActsFromItsRowOnIsLeftAlone) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed)
    for (const double colour : {0.0, 0.9, 0.99})
      for (const double noise : {0.0, 0.02, 0.2})
        EXPECT_FALSE(readSame(openLoop(0, noise, seed, colour))) << seed << ", " << colour;
}

TEST(RowReading, AClosedLoopIsHardlyEverReadAsAnInputThatActsWithinItsSample) {
  int wrong = 0, loops = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const double gain : {0.5, 2.0})
      for (const double integral : {0.0, 0.1})
        for (const double noise : {0.0, 0.05}) {
          for (const double setpoint : {0.0, 1.0}) {
            ++loops;
            if (readSame(closedLoop(gain, integral, noise, seed, setpoint))) ++wrong;
          }
        }
  EXPECT_LE(wrong, loops / 20) << "of " << loops;
}

TEST(RowReading, WhatIsAskedForIsNotLookedFor) {
  EXPECT_TRUE(readRows(openLoop(0, 0.02, 1, 0.0), RowReading::kSame).same[0]);
  EXPECT_FALSE(readRows(openLoop(1, 0.02, 1, 0.0), RowReading::kNext).same[0]);
}

TEST(RowReading, ColumnsMoveUpByOneRowWithinEachPiece) {
  Matrix values(6, 2);
  values << 1, 10, 2, 20, kNaN, kNaN, 4, 40, 5, 50, 6, 60;
  DataSet data;
  data.values = values;
  data.outputs = {{"y", "", 0, 10}};
  data.inputs = {{"u", "", 0, 100}};
  const Matrix moved = asRead(data, {true}).values;
  const double expected[] = {20, 20, kNaN, 50, 60, 60};
  for (Index k = 0; k < 6; ++k)
    EXPECT_TRUE(moved(k, 1) == expected[k] || (std::isnan(moved(k, 1)) && std::isnan(expected[k])));
  EXPECT_EQ(moved.col(0).head(2), values.col(0).head(2));
}

TEST(RowReading, TheSearchTakesItAndTheFirstRemarkSaysSo) {
  const DataSet data = openLoop(1, 0.02, 3, 0.5);
  AutoParams params;
  params.states = false;
  params.work = 0.2;
  const AutoIdentification found = autoIdentify(data, params);
  ASSERT_EQ(found.same_row, std::vector<bool>{true});
  EXPECT_LT(found.outputs[0].linear.one_step, 0.05);
  params.rows = RowReading::kNext;
  EXPECT_GT(autoIdentify(data, params).outputs[0].linear.one_step, 0.1);
}

}  // namespace identification_row_reading_test
}  // namespace fpc
