#include "optim/least_squares.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <random>

namespace fpc {
namespace optim_least_squares_test {

TEST(LeastSquares, ALineThroughItsPointsIsFoundExactly) {
  LeastSquares squares(2);
  for (int i = 0; i < 5; ++i) squares.add((Vector(2) << i, 1.0).finished(), 3.0 * i - 2.0);
  const auto solution = squares.solve();
  EXPECT_NEAR(solution.theta[0], 3.0, 1e-13);
  EXPECT_NEAR(solution.theta[1], -2.0, 1e-13);
  EXPECT_EQ(solution.rank, 2);
  EXPECT_EQ(squares.rows(), 5U);
}

TEST(LeastSquares, RowsInBlocksGiveWhatAllRowsAtOnceGive) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    const Eigen::Index rows = 700, n = 7;
    Matrix x(rows, n);
    Vector y(rows), weight(rows);
    LeastSquares squares(n);
    for (Eigen::Index k = 0; k < rows; ++k) {
      for (Eigen::Index j = 0; j < n; ++j)
        x(k, j) = std::pow(10.0, static_cast<double>(j) - 3.0) * normal(generator);
      y[k] = normal(generator);
      weight[k] = std::abs(normal(generator));
      squares.add(x.row(k).transpose(), y[k], weight[k]);
    }
    const Vector root = weight.cwiseSqrt();
    const Vector dense = (root.asDiagonal() * x).householderQr().solve(root.cwiseProduct(y));
    EXPECT_LT(((squares.solve().theta - dense).array() / dense.array()).abs().maxCoeff(), 1e-9);
  }
}

TEST(LeastSquares, TheConditionNumberIgnoresUnits) {
  LeastSquares squares(2);
  for (int i = 0; i < 8; ++i)
    squares.add((Vector(2) << (i % 2 ? 1.0 : -1.0), 1e6 * (i % 4 < 2 ? 1.0 : -1.0)).finished(),
                1.0);
  EXPECT_NEAR(squares.solve().condition, 1.0, 1e-6);
}

TEST(LeastSquares, TheConditionNumberOfTwoNearlyEqualColumnsIsKnown) {
  // Unit columns at angle a have singular values sqrt(1 +- cos a).
  const double a = 1e-3;
  LeastSquares squares(2);
  squares.add((Vector(2) << 1.0, std::cos(a)).finished(), 0.0);
  squares.add((Vector(2) << 0.0, std::sin(a)).finished(), 0.0);
  EXPECT_NEAR(squares.solve().condition, 1.0 / std::tan(a / 2.0), 1.0);
}

TEST(LeastSquares, WhatTheDataDoNotDetermineIsReportedAndStaysFinite) {
  LeastSquares squares(3);
  for (int i = 0; i < 20; ++i) squares.add((Vector(3) << i, 2.0 * i, 0.0).finished(), 5.0 * i);
  const auto solution = squares.solve();
  EXPECT_EQ(solution.rank, 1);
  EXPECT_TRUE(std::isinf(solution.condition));
  ASSERT_TRUE(solution.theta.allFinite());
  EXPECT_NEAR(solution.theta[0] + 2.0 * solution.theta[1], 5.0, 1e-12);
  EXPECT_EQ(solution.theta[2], 0.0);
}

TEST(LeastSquares, TheRidgeIsWorthItsSamples) {
  // One coefficient, 4 samples of x = 1, y = 1, ridge 1: theta = 4 / (4 + 1).
  LeastSquares squares(1);
  for (int i = 0; i < 4; ++i) squares.add(Vector::Ones(1), 1.0);
  EXPECT_NEAR(squares.solve(1.0).theta[0], 0.8, 1e-14);
}

TEST(LeastSquares, NoRowsGiveZeros) {
  LeastSquares squares(2);
  squares.add(Vector::Ones(2), 1.0, 0.0);
  EXPECT_EQ(squares.rows(), 0U);
  EXPECT_EQ(squares.solve().theta, Vector::Zero(2));
  EXPECT_EQ(squares.solve().rank, 0);
}

}  // namespace optim_least_squares_test
}  // namespace fpc
