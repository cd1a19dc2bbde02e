// The equations of one working set solved with its factors: refined until what is left is rounding.
#include <algorithm>
#include <cmath>
#include <limits>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMaxCorrections = 4;
constexpr int kMaxShiftedCorrections = 30;

}  // namespace

/// hx = H x
void KktSystem::applyHessian(const QpProblem& p, const Vector& x) {
  if (diagonal_)
    hx_ = p.H.diagonal().cwiseProduct(x);
  else
    product(p.H, x, hx_);
}

/// Errors of the KKT equations. @return whether they are down to rounding
bool KktSystem::residual(const QpProblem& p, QpResult& result) {
  const Index n_r = n_rows_;
  applyHessian(p, result.x);
  if (n_r > 0) {
    product(At_.leftCols(n_r), y_, aty_);
    transposedProduct(At_.leftCols(n_r), result.x, residual_row_);
    residual_row_.head(n_r) *= -1.0;
  } else {
    aty_.setZero();
  }
  double worst = 0.0, largest = 0.0;
  for (Index j = 0; j < n_free_; ++j) {
    const Index i = order_[static_cast<std::size_t>(j)];
    const double error = aty_(i) - hx_(i) - p.g(i);
    residual_free_(j) = error;
    worst = std::max(worst, std::abs(error));
    largest = std::max(largest, std::abs(hx_(i)) + std::abs(p.g(i)) + std::abs(aty_(i)));
  }
  bool small = worst <= 4.0 * kEpsilon * largest;
  for (Index k = 0; k < n_r; ++k) {
    const Index row = rows_[static_cast<std::size_t>(k)];
    const double limit = limitOf(p, p.g.size() + row, row_side_[static_cast<std::size_t>(k)]);
    residual_row_(k) += limit;
    small = small &&
            std::abs(residual_row_(k)) <=
                4.0 * kEpsilon * (std::abs(limit) + At_.col(k).cwiseAbs().dot(result.x.cwiseAbs()));
  }
  return small;
}

void KktSystem::correct(QpResult& result) {
  const Index n_f = n_free_, n_r = n_rows_;
  auto w = work_.head(n_f);
  w = residual_free_.head(n_f);
  const auto L = L_.topLeftCorner(n_f, n_f).triangularView<Eigen::Lower>();
  if (diagonal_)
    w.array() /= L_.diagonal().head(n_f).array();
  else if (n_f > 0)
    L.solveInPlace(w);
  if (n_r > 0) {
    const auto R = R_.topLeftCorner(n_r, n_r).triangularView<Eigen::Upper>();
    auto step = residual_row_.head(n_r);
    auto projection = work_row_.head(n_r);
    R.transpose().solveInPlace(step);
    transposedProduct(Q_.topLeftCorner(n_f, n_r), w, projection);
    step -= projection;
    addProduct(1.0, Q_.topLeftCorner(n_f, n_r), step, w);
    R.solveInPlace(step);
    y_.head(n_r) += step;
  }
  if (diagonal_)
    w.array() /= L_.diagonal().head(n_f).array();
  else if (n_f > 0)
    L.transpose().solveInPlace(w);
  for (Index j = 0; j < n_f; ++j) result.x(order_[static_cast<std::size_t>(j)]) += w(j);
}

void KktSystem::solve(const QpProblem& p, const Sides& sides, QpResult& result) {
  const Index n = p.g.size();
  for (Index j = n_free_; j < n; ++j) {
    const Index i = order_[static_cast<std::size_t>(j)];
    result.x(i) = limitOf(p, i, sides[static_cast<std::size_t>(i)]);
  }
  for (Index k = 0; k < n_rows_; ++k) y_(k) = result.y_a(rows_[static_cast<std::size_t>(k)]);
  const int corrections = shifted() ? kMaxShiftedCorrections : kMaxCorrections;
  for (int correction = 0; !residual(p, result) && correction < corrections; ++correction)
    correct(result);
  result.y_x.setZero();
  result.y_a.setZero();
  for (Index k = 0; k < n_rows_; ++k) result.y_a(rows_[static_cast<std::size_t>(k)]) = y_(k);
  for (Index j = n_free_; j < n; ++j) {
    const Index i = order_[static_cast<std::size_t>(j)];
    result.y_x(i) = hx_(i) + p.g(i) - aty_(i);
  }
}

void KktSystem::evaluate(const QpProblem& p, const QpResult& result) {
  applyHessian(p, result.x);
  aty_.setZero();
  if (p.a_lower.size() > 0) transposedProduct(p.A, result.y_a, aty_);
}

}  // namespace fpc::qp
