#include "optim/rls.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>
#include <random>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace optim_rls_test {

struct Samples {
  Matrix x;
  Vector y, weight;
};

Samples randomSamples(std::uint64_t seed, Eigen::Index rows, Eigen::Index n) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.05, 1.0);
  Samples s{Matrix(rows, n), Vector(rows), Vector(rows)};
  const Vector truth = Vector::LinSpaced(n, -1.0, 2.0);
  for (Eigen::Index k = 0; k < rows; ++k) {
    for (Eigen::Index j = 0; j < n; ++j) s.x(k, j) = normal(generator);
    s.y[k] = s.x.row(k).dot(truth) + 0.1 * normal(generator);
    s.weight[k] = unit(generator);
  }
  return s;
}

TEST(RecursiveLeastSquares, WithoutForgettingEqualsTheBatchSolution) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Samples s = randomSamples(seed, 200, 5);
    RlsParams params;
    params.initial_covariance = 1e2;
    const Vector start = Vector::Constant(5, 0.3);
    RecursiveLeastSquares rls(start, params);
    for (Eigen::Index k = 0; k < s.y.size(); ++k)
      EXPECT_TRUE(rls.update(s.x.row(k).transpose(), s.y[k], s.weight[k]));
    const Matrix information = s.x.transpose() * s.weight.asDiagonal() * s.x +
                               Matrix::Identity(5, 5) / params.initial_covariance;
    const Vector right =
        s.x.transpose() * s.weight.cwiseProduct(s.y) + start / params.initial_covariance;
    const Vector batch = information.ldlt().solve(right);
    EXPECT_LT((rls.theta() - batch).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((rls.covariance() * information - Matrix::Identity(5, 5)).cwiseAbs().maxCoeff(),
              1e-9);
  }
}

TEST(RecursiveLeastSquares, AFaintStartLeavesPlainLeastSquares) {
  const Samples s = randomSamples(4, 300, 4);
  RlsParams params;
  params.initial_covariance = 1e9;
  params.covariance_bound = 1e9;
  RecursiveLeastSquares rls(Vector::Zero(4), params);
  for (Eigen::Index k = 0; k < s.y.size(); ++k) rls.update(s.x.row(k).transpose(), s.y[k]);
  const Vector batch = (s.x.transpose() * s.x).ldlt().solve(s.x.transpose() * s.y);
  EXPECT_LT((rls.theta() - batch).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(RecursiveLeastSquares, ForgettingWeighsSamplesByAge) {
  const Samples s = randomSamples(7, 60, 3);
  RlsParams params;
  params.forgetting = 0.9;
  params.initial_covariance = 1e3;
  params.covariance_bound = 1e12;
  RecursiveLeastSquares rls(Vector::Zero(3), params);
  Matrix information = Matrix::Identity(3, 3) / params.initial_covariance;
  Vector right = Vector::Zero(3);
  for (Eigen::Index k = 0; k < s.y.size(); ++k) {
    const Vector x = s.x.row(k).transpose();
    rls.update(x, s.y[k]);
    information = params.forgetting * information + x * x.transpose();
    right = params.forgetting * right + x * s.y[k];
  }
  EXPECT_LT((rls.theta() - information.ldlt().solve(right)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(RecursiveLeastSquares, ACovarianceWithoutExcitationStaysBounded) {
  RlsParams params;
  params.forgetting = 0.95;
  params.initial_covariance = 10.0;
  params.covariance_bound = 50.0;
  RecursiveLeastSquares rls(Vector::Zero(2), params);
  const Vector x =
      (Vector(2) << 1.0, 0.0).finished();  // nothing is ever said about the second coefficient
  for (int k = 0; k < 5000; ++k) {
    rls.update(x, 1.0);
    ASSERT_LE(rls.covariance().diagonal().maxCoeff(), 50.0 * (1.0 + 1e-9));
    ASSERT_TRUE(rls.theta().allFinite());
  }
  EXPECT_GT(rls.bounded(), 1000U);
  EXPECT_NEAR(rls.theta()[0], 1.0, 1e-6);
  EXPECT_EQ(rls.theta()[1], 0.0);
}

TEST(RecursiveLeastSquares, TheCovarianceStaysPositiveThroughIllConditionedData) {
  RlsParams params;
  params.forgetting = 0.98;
  RecursiveLeastSquares rls(Vector::Zero(3), params);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 20000; ++k) {
    const double a = normal(generator);
    const Vector x = (Vector(3) << a, a * (1.0 + 1e-9), 1e-7 * normal(generator)).finished();
    rls.update(x, a);
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(rls.covariance());
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-12 * eigen.eigenvalues().maxCoeff());
  EXPECT_TRUE(rls.theta().allFinite());
}

TEST(RecursiveLeastSquares, ARuleThatDoesNotFireForgetsNothing) {
  RlsParams params;
  params.forgetting = 0.9;
  RecursiveLeastSquares rls(Vector::Zero(2), params);
  const Vector x = (Vector(2) << 1.0, 2.0).finished();
  rls.update(x, 3.0);
  const Matrix before = rls.covariance();
  EXPECT_FALSE(rls.update(x, 100.0, 0.0));
  EXPECT_EQ(rls.covariance(), before);
  EXPECT_EQ(rls.skipped(), 0U);
}

TEST(RecursiveLeastSquares, SamplesThatAreNotFiniteAreSkippedAndCounted) {
  RecursiveLeastSquares rls(Vector::Zero(1), {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(rls.update(Vector::Constant(1, nan), 1.0));
  EXPECT_FALSE(rls.update(Vector::Ones(1), nan));
  EXPECT_FALSE(rls.update(Vector::Ones(2), 1.0));
  EXPECT_EQ(rls.skipped(), 3U);
  EXPECT_EQ(rls.theta()[0], 0.0);
}

TEST(RecursiveLeastSquares, BadParametersAreNamed) {
  RlsParams params;
  params.forgetting = 1.1;
  EXPECT_THROW(RecursiveLeastSquares(Vector::Zero(1), params), InputError);
  params = {};
  params.covariance_bound = 1.0;
  EXPECT_THROW(params.validate(), InputError);
  EXPECT_THROW(RecursiveLeastSquares(Vector(), {}), InputError);
}

}  // namespace optim_rls_test
}  // namespace fpc
