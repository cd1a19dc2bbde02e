// The shift that makes a semidefinite Hessian definite: a multiple of diag(s)^-2, s the column
// scales that equilibrate the matrix [H A'; A 0] (ruiz2001), so that units do not matter.
#include <algorithm>
#include <cmath>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr int kSweeps = 8;
constexpr double kShift = 1e-6;          // of the equilibrated Hessian, to begin with
constexpr double kLeastShift = 1e-10;    // and in the end
constexpr double kSemidefinite = 1e-11;  // a negative eigenvalue of that size is rounding

void divideByRoot(double& scale, double largest) {
  if (largest > 0.0 && std::isfinite(largest)) scale /= std::sqrt(largest);
}

}  // namespace

/// Leaves s in shift_ and the scales of the rows in row_scale_.
void KktSystem::equilibrate(const QpProblem& p) {
  const Index n = H_.rows(), m = p.a_lower.size();
  shift_.setOnes();
  row_scale_.setOnes();
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    row_largest_.setZero();
    for (Index j = 0; j < n; ++j) {
      const double cost = diagonal_ ? std::abs(H_(j, j)) * shift_(j)
                                    : H_.col(j).cwiseAbs().cwiseProduct(shift_).maxCoeff();
      const double row =
          m > 0 ? largestOf(p.A.col(j).data(), m, row_scale_.data(), shift_(j), row_largest_.data())
                : 0.0;
      work_(j) = std::max(cost, row) * shift_(j);
    }
    for (Index i = 0; i < m; ++i) divideByRoot(row_scale_(i), row_largest_(i) * row_scale_(i));
    for (Index j = 0; j < n; ++j) divideByRoot(shift_(j), work_(j));
  }
}

bool KktSystem::regularise(const QpProblem& p) {
  equilibrate(p);
  const double cost = std::max(H_.diagonal().cwiseProduct(shift_).cwiseProduct(shift_).maxCoeff(),
                               p.g.cwiseProduct(shift_).lpNorm<Eigen::Infinity>());
  const double size = cost > 0.0 ? cost : 1.0;
  shift_ = size * shift_.cwiseAbs2().cwiseInverse();
  shift_ *= kSemidefinite;
  shift_size_ = kSemidefinite;
  std::fill(fixed_.begin(), fixed_.end(), char{0});
  forgetFactors();
  for (Index i = 0; i < H_.rows(); ++i) order_[static_cast<std::size_t>(i)] = i;
  n_free_ = 0;
  factored_ = true;
  const bool semidefinite = complete();
  forgetFactors();
  shift_ *= kShift / kSemidefinite;
  shift_size_ = kShift;
  return semidefinite && shift_.allFinite();
}

bool KktSystem::reduceShift(double factor) {
  if (shift_size_ * factor < kLeastShift * 0.99) return false;
  shift_ *= factor;
  shift_size_ *= factor;
  forgetFactors();
  return true;
}

}  // namespace fpc::qp
