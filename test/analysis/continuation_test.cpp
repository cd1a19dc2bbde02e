// Textbook systems whose folds, Hopf points and branches are known on paper.
#include "analysis/continuation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/linearise.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_continuation_test {

ContinuationParams box(double lower, double upper, Eigen::Index n_x, double size) {
  ContinuationParams params;
  params.lower = lower;
  params.upper = upper;
  params.state_lower = Vector::Constant(n_x, -size);
  params.state_upper = Vector::Constant(n_x, size);
  params.state_size = Vector::Ones(n_x);
  params.parameter_size = 1.0;
  return params;
}

std::vector<SpecialPoint> allOf(const std::vector<Branch>& branches, SpecialKind kind) {
  std::vector<SpecialPoint> found;
  for (const auto& branch : branches)
    for (const auto& point : branch.special)
      if (point.kind == kind) found.push_back(point);
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.parameter < b.parameter; });
  return found;
}

TEST(Continuation, FindsBothFoldsOfACubicOnOneBranch) {
  const ContinuationProblem cubic{[](VectorRef x, double p, Eigen::Ref<Vector> f) {
                                    f[0] = p + x[0] - x[0] * x[0] * x[0] / 3.0;
                                  },
                                  {},
                                  false};
  const auto branches = continueBranches(cubic, box(-2.0, 2.0, 1, 3.0));
  ASSERT_EQ(branches.size(), 1U);
  EXPECT_FALSE(branches[0].closed);
  const auto folds = allOf(branches, SpecialKind::kFold);
  ASSERT_EQ(folds.size(), 2U);
  EXPECT_NEAR(folds[0].parameter, -2.0 / 3.0, 1e-8);
  EXPECT_NEAR(folds[0].state[0], 1.0, 1e-5);
  EXPECT_NEAR(folds[1].parameter, 2.0 / 3.0, 1e-8);
  EXPECT_NEAR(folds[1].state[0], -1.0, 1e-5);
  for (const auto& point : branches[0].points)
    if (std::abs(std::abs(point.state[0]) - 1.0) > 1e-3)
      EXPECT_EQ(point.stable(), std::abs(point.state[0]) > 1.0) << point.state[0];
  double least = 0.0, most = 0.0;  // to the ends of the range
  for (const auto& point : branches[0].points) {
    least = std::min(least, point.parameter);
    most = std::max(most, point.parameter);
  }
  EXPECT_NEAR(least, -2.0, 1e-6);
  EXPECT_NEAR(most, 2.0, 1e-6);
}

TEST(Continuation, FindsEveryStateAtOneParameter) {
  const ContinuationProblem cubic{[](VectorRef x, double p, Eigen::Ref<Vector> f) {
                                    f[0] = p + x[0] - x[0] * x[0] * x[0] / 3.0;
                                  },
                                  {},
                                  false};
  EXPECT_EQ(steadyStatesAt(cubic, box(-2.0, 2.0, 1, 3.0), 0.0).size(), 3U);
  EXPECT_EQ(steadyStatesAt(cubic, box(-2.0, 2.0, 1, 3.0), 1.0).size(), 1U);
}

TEST(Continuation, ClosesAnIsolaWithItsFoldsAndExtremes) {
  const ContinuationProblem circle{
      [](VectorRef x, double p, Eigen::Ref<Vector> f) { f[0] = x[0] * x[0] + p * p - 1.0; },
      {},
      false};
  const auto branches = continueBranches(circle, box(-2.0, 2.0, 1, 2.0));
  ASSERT_EQ(branches.size(), 1U);
  EXPECT_TRUE(branches[0].closed);
  const auto folds = allOf(branches, SpecialKind::kFold);
  ASSERT_EQ(folds.size(), 2U);
  EXPECT_NEAR(folds[0].parameter, -1.0, 1e-8);
  EXPECT_NEAR(folds[1].parameter, 1.0, 1e-8);
  const auto extremes = allOf(branches, SpecialKind::kTurningPoint);
  ASSERT_EQ(extremes.size(), 2U);
  for (const auto& extreme : extremes) {
    EXPECT_NEAR(std::abs(extreme.state[0]), 1.0, 1e-8);
    EXPECT_EQ(extreme.turning_state, 0);
  }
}

TEST(Continuation, KeepsSeparateBranchesApart) {
  const ContinuationProblem lines{[](VectorRef x, double p, Eigen::Ref<Vector> f) {
                                    f[0] = (x[0] - 1.0 - 0.1 * p) * (x[0] + 1.0);
                                  },
                                  {},
                                  false};
  const auto branches = continueBranches(lines, box(-1.0, 1.0, 1, 2.0));
  EXPECT_EQ(branches.size(), 2U);
  EXPECT_TRUE(allOf(branches, SpecialKind::kFold).empty());
}

TEST(Continuation, FindsTheHopfPointOfItsNormalForm) {
  const ContinuationProblem hopf{[](VectorRef x, double p, Eigen::Ref<Vector> f) {
                                   const double r = x.squaredNorm();
                                   f[0] = (p - 0.3) * x[0] - 2.0 * x[1] - x[0] * r;
                                   f[1] = 2.0 * x[0] + (p - 0.3) * x[1] - x[1] * r;
                                 },
                                 {},
                                 false};
  const auto branches = continueBranches(hopf, box(-1.0, 1.0, 2, 1.0));
  const auto points = allOf(branches, SpecialKind::kHopf);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].parameter, 0.3, 1e-8);
  EXPECT_NEAR(points[0].eigenvalue.imag(), 2.0, 1e-6);
  EXPECT_TRUE(allOf(branches, SpecialKind::kFold).empty());
}

TEST(Continuation, OfAMapFindsTheFlipOfTheLogisticMapAndTheHopfOfTheDelayedOne) {
  const ContinuationProblem logistic{
      [](VectorRef x, double r, Eigen::Ref<Vector> f) { f[0] = r * (1.0 - x[0]) - 1.0; },
      [](VectorRef x, double r) { return Matrix::Constant(1, 1, r * (1.0 - 2.0 * x[0])); }, true};
  const auto flips = allOf(continueBranches(logistic, box(1.5, 3.9, 1, 2.0)), SpecialKind::kFlip);
  ASSERT_EQ(flips.size(), 1U);
  EXPECT_NEAR(flips[0].parameter, 3.0, 1e-7);

  const ContinuationProblem delayed{
      [](VectorRef x, double r, Eigen::Ref<Vector> f) { f[0] = r * (1.0 - x[0]) - 1.0; },
      [](VectorRef x, double r) {
        return (Matrix(2, 2) << r * (1.0 - x[0]), -r * x[0], 1.0, 0.0).finished();
      },
      true};
  const auto points = allOf(continueBranches(delayed, box(1.2, 2.8, 1, 2.0)), SpecialKind::kHopf);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_NEAR(points[0].parameter, 2.0, 1e-7);
  EXPECT_NEAR(std::arg(points[0].eigenvalue), M_PI / 3.0, 1e-6);
}

TEST(Continuation, EndsWhereTheFieldCannotBeEvaluated) {
  const ContinuationProblem root{[](VectorRef x, double p, Eigen::Ref<Vector> f) {
                                   if (p > 0.5) throw InputError("p: expected at most 0.5");
                                   f[0] = x[0] - p;
                                 },
                                 {},
                                 false};
  const auto branches = continueBranches(root, box(-1.0, 1.0, 1, 2.0));
  ASSERT_EQ(branches.size(), 1U);
  for (const auto& point : branches[0].points) EXPECT_LE(point.parameter, 0.5);
}

TEST(Continuation, RefusesParametersThatDoNotFit) {
  const ContinuationProblem any{
      [](VectorRef x, double, Eigen::Ref<Vector> f) { f = x; }, {}, false};
  EXPECT_THROW(continueBranches(any, box(1.0, -1.0, 1, 1.0)), InputError);
  ContinuationParams params = box(0.0, 1.0, 1, 1.0);
  params.state_size.setZero();
  EXPECT_THROW(continueBranches(any, params), InputError);
}

TEST(Linearise, SampleAndHoldOfAFirstOrderLagIsExact) {
  const SampledMatrices m =
      sampleAndHold(Matrix::Constant(1, 1, -2.0), Matrix::Constant(1, 1, 3.0), 0.25);
  EXPECT_NEAR(m.A(0, 0), std::exp(-0.5), 1e-14);
  EXPECT_NEAR(m.B(0, 0), 1.5 * (1.0 - std::exp(-0.5)), 1e-14);
}

TEST(Linearise, ALocalLoopOnTheDifferenceKeepsTheSteadyGain) {
  const Matrix A = Matrix::Constant(1, 1, -1.0), B = Matrix::Constant(1, 1, 1.0);
  const Matrix K = Matrix::Constant(1, 1, 0.7);
  const Matrix map = sampledLocalLoop(A, B, 0.1, K, -K);
  const double a = std::exp(-0.1), b = 1.0 - a;
  EXPECT_NEAR(map(0, 0), a + 0.7 * b, 1e-14);
  EXPECT_NEAR(map(0, 1), -0.7 * b, 1e-14);
  EXPECT_EQ(map(1, 0), 1.0);
  const Eigen::Vector2d rest = map * Eigen::Vector2d(1.0, 1.0) + Eigen::Vector2d(b, 0.0);
  EXPECT_NEAR((rest - Eigen::Vector2d(1.0, 1.0)).norm(), 0.0, 1e-14);
}

}  // namespace analysis_continuation_test
}  // namespace fpc
