#include "analysis/common_lyapunov.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/closed_loop.hpp"
#include "analysis/csdp.hpp"
#include "base/decompositions.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr int kBisections = 8;
constexpr int kLyapunovDoublings = 40;
constexpr double kRounding = 1e-9;  // what a certified decay must stay below 1

/// Upper factor R of P = R' R with A' P A - P = -I for the mean map: its coordinates make the
/// programme round. Identity if the mean map is not stable.
Matrix roundCoordinates(const std::vector<Matrix>& maps) {
  const Eigen::Index n = maps.front().rows();
  Matrix A = Matrix::Zero(n, n);
  for (const auto& map : maps) A += map / static_cast<double>(maps.size());
  Matrix P = Matrix::Identity(n, n);
  for (int i = 0; i < kLyapunovDoublings; ++i) {
    P += (A.transpose() * P * A).eval();
    A = (A * A).eval();
    if (!P.allFinite()) return Matrix::Identity(n, n);
  }
  const Eigen::LLT<Matrix> factor(0.5 * (P + P.transpose()));
  if (factor.info() != Eigen::Success || A.norm() > 1e-3) return Matrix::Identity(n, n);
  return factor.matrixU();
}

double norm2(const Matrix& A) { return svdOf(A).singularValues()[0]; }

}  // namespace

double certifiedDecay(MatrixRef P, const std::vector<Matrix>& maps) {
  const double none = std::numeric_limits<double>::infinity();
  if (!P.allFinite() || (P - P.transpose()).cwiseAbs().maxCoeff() > 1e-12 * P.norm()) return none;
  const Eigen::LLT<Matrix> factor{Matrix(P)};
  if (factor.info() != Eigen::Success || factor.matrixLLT().diagonal().minCoeff() <= 0.0)
    return none;
  const Matrix L = factor.matrixL();
  double decay = 0.0;
  for (const auto& A : maps) {
    // L' A L'^-1 = (L^-1 A' L)'
    const Matrix transposed = factor.matrixL().solve(Matrix(A.transpose() * L));
    decay = std::max(decay, norm2(transposed));
  }
  return decay;
}

CommonLyapunov commonLyapunov(const std::vector<Matrix>& maps) {
  require(!maps.empty(), "maps", "at least one");
  const Eigen::Index n = maps.front().rows();
  double radius = 0.0;
  for (const auto& A : maps) {
    require(A.rows() == n && A.cols() == n && A.allFinite(), "maps", "finite, square, of one size");
    radius = std::max(radius, spectralRadius(eigenvalues(A)));
  }
  CommonLyapunov result;
  if (radius >= 1.0) return result;
  const Matrix R = roundCoordinates(maps);
  const Matrix inverse = R.triangularView<Eigen::Upper>().solve(Matrix::Identity(n, n));
  std::vector<Matrix> scaled;
  for (const auto& A : maps) scaled.push_back(R * A * inverse);
  double low = radius, high = 1.0;
  for (int i = 0; i <= kBisections; ++i) {
    const double decay = i == 0 ? 1.0 : 0.5 * (low + high);
    Matrix Q;
    double margin = 0.0;
    const CsdpOutcome outcome = solveDecay(scaled, decay, Q, margin);
    if (outcome == CsdpOutcome::kMissing) {
      result.status = LyapunovStatus::kNoSolver;
      return result;
    }
    const double certified = outcome == CsdpOutcome::kSolved
                                 ? certifiedDecay(Q, scaled)
                                 : std::numeric_limits<double>::infinity();
    if (certified < result.decay && certified < 1.0 - kRounding) {
      Matrix P = R.transpose() * Q * R;
      P = (0.5 * (P + P.transpose())).eval();
      const double plain = certifiedDecay(P, maps);
      if (plain < 1.0 - kRounding) {
        result = {LyapunovStatus::kFound, P / norm2(P), plain};
      }
    }
    if (i == 0 && !result.ok()) {
      if (outcome == CsdpOutcome::kTrouble) result.status = LyapunovStatus::kTrouble;
      return result;
    }
    if (result.ok() && result.decay <= decay * (1.0 + 1e-6))
      high = result.decay;
    else
      low = decay;
  }
  return result;
}

CertifiedRegion largestRegion(const std::vector<Matrix>& maps,
                              const std::vector<std::size_t>& order) {
  CertifiedRegion region;
  std::vector<Matrix> kept;
  for (const std::size_t i : order) {
    require(i < maps.size(), "order", "indices of maps");
    kept.push_back(maps[i]);
    const CommonLyapunov grown = commonLyapunov(kept);
    if (grown.ok()) {
      region.members.push_back(i);
      region.certificate = grown;
      continue;
    }
    kept.pop_back();
    if (grown.status == LyapunovStatus::kNoSolver) {
      region.certificate.status = grown.status;
      return region;
    }
  }
  return region;
}

}  // namespace fpc
