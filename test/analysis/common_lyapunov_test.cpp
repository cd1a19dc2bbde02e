// Certificates on systems whose answer is known.
#include "analysis/common_lyapunov.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "analysis/closed_loop.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace analysis_common_lyapunov_test {

Matrix of(double a, double b, double c, double d) {
  return (Matrix(2, 2) << a, b, c, d).finished();
}

double radius(const Matrix& A) { return spectralRadius(eigenvalues(A)); }

/// The rules of tanaka1992, example 4.2: each stable, no common P.
const std::vector<Matrix> kTanakaSugeno = {of(1.0, -0.5, 1.0, 0.0), of(-1.0, -0.5, 1.0, 0.0)};

void expectDecrease(const CommonLyapunov& found, const std::vector<Matrix>& maps) {
  ASSERT_EQ(found.status, LyapunovStatus::kFound);
  const Eigen::SelfAdjointEigenSolver<Matrix> of_P(found.P);
  EXPECT_GT(of_P.eigenvalues().minCoeff(), 0.0);
  for (const auto& A : maps) {
    const Matrix change = A.transpose() * found.P * A - found.decay * found.decay * found.P;
    EXPECT_LE(Eigen::SelfAdjointEigenSolver<Matrix>(change).eigenvalues().maxCoeff(), 1e-9);
  }
  EXPECT_LT(found.decay, 1.0);
}

TEST(CommonLyapunov, IsFoundForTwoRulesThatHaveOne) {
  const std::vector<Matrix> maps = {of(0.5, 0.2, 0.0, 0.4), of(0.3, 0.0, -0.3, 0.6)};
  expectDecrease(commonLyapunov(maps), maps);
}

TEST(CommonLyapunov, DoesNotExistForTheRulesOfTanakaAndSugeno) {
  for (const auto& A : kTanakaSugeno) EXPECT_LT(radius(A), 1.0);
  EXPECT_GT(radius(kTanakaSugeno[0] * kTanakaSugeno[1]), 1.0);  // hence none can exist
  const CommonLyapunov found = commonLyapunov(kTanakaSugeno);
  EXPECT_EQ(found.status, LyapunovStatus::kNone);
}

TEST(CommonLyapunov, DoesNotExistWhereSwitchingBetweenStableMapsDiverges) {
  const std::vector<Matrix> maps = {of(0.5, 2.0, 0.0, 0.5), of(0.5, 0.0, 2.0, 0.5)};
  EXPECT_EQ(radius(maps[0]), 0.5);
  EXPECT_GT(radius(maps[0] * maps[1]), 1.0);
  EXPECT_FALSE(commonLyapunov(maps).ok());
}

TEST(CommonLyapunov, OfOneMapDecaysAlmostLikeItsLargestEigenvalue) {
  const std::vector<Matrix> maps = {of(0.8, 1.0, 0.0, 0.5)};
  const CommonLyapunov found = commonLyapunov(maps);
  expectDecrease(found, maps);
  EXPECT_GE(found.decay, 0.8);
  EXPECT_LT(found.decay, 0.81);
}

TEST(CommonLyapunov, StandsBadScalesOfTheStates) {
  const Matrix T = of(1e5, 0.0, 0.0, 1e-3), back = of(1e-5, 0.0, 0.0, 1e3);
  const std::vector<Matrix> maps = {T * of(0.5, 0.2, 0.0, 0.4) * back,
                                    T * of(0.3, 0.0, -0.3, 0.6) * back};
  const CommonLyapunov found = commonLyapunov(maps);
  ASSERT_TRUE(found.ok());
  EXPECT_NEAR(certifiedDecay(found.P, maps), found.decay, 1e-9);
}

TEST(CommonLyapunov, AnUnstableMapHasNone) {
  EXPECT_EQ(commonLyapunov({of(1.1, 0.0, 0.0, 0.1)}).status, LyapunovStatus::kNone);
}

TEST(CertifiedDecay, IsInfiniteForAnIndefiniteOrCrookedMatrix) {
  const std::vector<Matrix> maps = {of(0.1, 0.0, 0.0, 0.1)};
  EXPECT_TRUE(std::isinf(certifiedDecay(of(1.0, 0.0, 0.0, -1.0), maps)));
  EXPECT_TRUE(std::isinf(certifiedDecay(of(1.0, 0.5, 0.0, 1.0), maps)));
  EXPECT_NEAR(certifiedDecay(of(1.0, 0.0, 0.0, 1.0), maps), 0.1, 1e-15);
}

TEST(LargestRegion, LeavesOutTheRuleThatBreaksTheCertificate) {
  std::vector<Matrix> maps = kTanakaSugeno;
  maps.push_back(of(0.5, 0.0, 0.0, 0.5));
  const CertifiedRegion region = largestRegion(maps, {0, 1, 2});
  EXPECT_EQ(region.members, (std::vector<std::size_t>{0, 2}));
  EXPECT_TRUE(region.certificate.ok());
  EXPECT_THROW(commonLyapunov({}), InputError);
}

}  // namespace analysis_common_lyapunov_test
}  // namespace fpc
