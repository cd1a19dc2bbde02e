#include "fmbpc/base/state_space.hpp"

#include <gtest/gtest.h>

#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_state_space_test {

TEST(PowerSum, ScalarGeometricSeries) {
  PowerSum sums(1);
  sums.compute(Matrix::Constant(1, 1, 0.5), 4);
  EXPECT_DOUBLE_EQ(sums.power()(0, 0), 0.0625);
  EXPECT_DOUBLE_EQ(sums.sum()(0, 0), 1.0 + 0.5 + 0.25 + 0.125);
}

// A has an eigenvalue 1, so (A - I) is singular: the sum over H = 180 is 180 in that direction.
TEST(PowerSum, UnitEigenvaluesNeedNoInverse) {
  Matrix A(2, 2);
  A << 1.0, 0.0, 0.0, 0.9;
  PowerSum sums(2);
  sums.compute(A, 180);
  EXPECT_DOUBLE_EQ(sums.sum()(0, 0), 180.0);
  EXPECT_NEAR(sums.sum()(1, 1), (1.0 - std::pow(0.9, 180)) / 0.1, 1e-13);
}

TEST(PowerSum, DoublingEqualsPlainSumForEveryHorizon) {
  constexpr unsigned kSeed = 3;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  std::uniform_real_distribution<double> entry(-0.5, 0.5);
  const Matrix A = Matrix::NullaryExpr(4, 4, [&] { return entry(generator); });
  PowerSum sums(4);
  Matrix power = Matrix::Identity(4, 4), sum = Matrix::Zero(4, 4);
  for (int horizon = 1; horizon <= 70; ++horizon) {
    sum += power;
    power = power * A;
    sums.compute(A, horizon);
    EXPECT_LT((sums.sum() - sum).norm(), 1e-12 * sum.norm()) << "horizon " << horizon;
    EXPECT_LT((sums.power() - power).norm(), 1e-12 * (1.0 + power.norm())) << "horizon " << horizon;
  }
}

TEST(PowerSum, WrongHorizonAndSizeAreErrors) {
  PowerSum sums(2);
  EXPECT_THROW(sums.compute(Matrix::Identity(2, 2), 0), InputError);
  EXPECT_THROW(sums.compute(Matrix::Identity(3, 3), 1), InputError);
}

TEST(AffineModel, StartsAtZeroWithTheRightShapes) {
  const AffineModel model(3, 2, 1);
  EXPECT_EQ(model.A.rows(), 3);
  EXPECT_EQ(model.B.cols(), 2);
  EXPECT_EQ(model.C.rows(), 1);
  EXPECT_EQ(model.g, Vector::Zero(3));
}

}  // namespace base_state_space_test
}  // namespace fpc
