// The KKT system of one working set. With the unknowns at a bound removed, v = L'x_f solves a
// least-squares problem:
//   v = w + Q (R^-T b - Q'w),  R y = R^-T b - Q'w,  w = L^-1 r_f   (null-space form of
//   goldfarb1983, 3).
// Answers are refined on the original data, so they do not depend on how the working set was found.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr double kPivotTolerance =
    1e-14;  // of H_ii: below it H is not positive definite in this arithmetic
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMaxCorrections = 4;
constexpr int kMaxShiftedCorrections = 30;

bool sameBits(const double* a, const double* b, Index count) {
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(double)) == 0;
}

}  // namespace

void KktSystem::resize(Index n, Index m) {
  const auto size = static_cast<std::size_t>(n);
  for (Matrix* M : {&H_, &L_, &At_, &Vt_, &Q_, &R_}) M->setZero(n, n);
  for (Vector* v :
       {&y_, &hx_, &aty_, &residual_free_, &residual_row_, &work_, &work_row_, &norm_, &shift_})
    v->setZero(n);
  row_scale_.setZero(m);
  shift_size_ = 0.0;
  order_.assign(size, 0);
  fixed_.assign(size, 0);
  rows_.assign(size, 0);
  row_side_.assign(size, kOff);
  n_free_ = n_rows_ = 0;
  factored_ = rows_factored_ = complete_ = definite_ = false;
}

void KktSystem::setHessian(const Matrix& H) {
  if (sameBits(H.data(), H_.data(), H.size())) return;
  H_ = H;
  shift_.setZero();
  shift_size_ = 0.0;
  forgetFactors();
}

void KktSystem::forgetFactors() { factored_ = rows_factored_ = complete_ = definite_ = false; }

/// Left-looking, for the given columns of L and the given rows (those on and below the diagonal).
bool KktSystem::cholesky(Index column_begin, Index column_end, Index row_begin, Index row_end) {
  for (Index j = column_begin; j < column_end; ++j) {
    const Index first = std::max(j, row_begin), count = row_end - first;
    const Index unknown = order_[static_cast<std::size_t>(j)];
    const double H_jj = H_(unknown, unknown) + shift_(unknown);
    auto column = L_.col(j).segment(first, count);
    if (j > 0) addProduct(-1.0, L_.block(first, 0, count, j), L_.row(j).head(j), column);
    if (first == j) {
      const double pivot = L_(j, j);
      if (!(pivot > kPivotTolerance * H_jj) || !std::isfinite(pivot)) return false;
      column *= 1.0 / std::sqrt(pivot);
    } else {
      column *= 1.0 / L_(j, j);
    }
  }
  return true;
}

bool KktSystem::factorFree(const QpProblem& p, const Sides& sides) {
  const Index n = p.g.size();
  bool same = factored_;
  Index free = 0, fixed = n;
  for (Index i = n; i-- > 0;) {
    const auto k = static_cast<std::size_t>(i);
    const char is_fixed = sides[k] != kOff ? 1 : 0;
    same = same && fixed_[k] == is_fixed;
    fixed_[k] = is_fixed;
    if (is_fixed) order_[static_cast<std::size_t>(--fixed)] = i;
  }
  if (same) return true;
  for (Index i = 0; i < n; ++i) {
    if (!fixed_[static_cast<std::size_t>(i)]) order_[static_cast<std::size_t>(free++)] = i;
  }
  n_free_ = free;
  factored_ = rows_factored_ = complete_ = false;
  for (Index j = 0; j < free; ++j) {
    const double* column = H_.data() + order_[static_cast<std::size_t>(j)] * n;
    for (Index i = j; i < free; ++i) L_(i, j) = column[order_[static_cast<std::size_t>(i)]];
    L_(j, j) += shift_(order_[static_cast<std::size_t>(j)]);
  }
  factored_ = cholesky(0, free, 0, free);
  return factored_;
}

bool KktSystem::complete() {
  if (complete_) return true;
  if (!factored_) return false;
  const Index n = H_.rows();
  for (Index j = 0; j < n; ++j) {
    const double* column = H_.data() + order_[static_cast<std::size_t>(j)] * n;
    for (Index i = std::max(j, n_free_); i < n; ++i)
      L_(i, j) = column[order_[static_cast<std::size_t>(i)]];
    if (j >= n_free_) L_(j, j) += shift_(order_[static_cast<std::size_t>(j)]);
  }
  complete_ = cholesky(0, n_free_, n_free_, n) && cholesky(n_free_, n, n_free_, n);
  definite_ = definite_ || complete_;
  return complete_;
}

/// Copies the working rows. @return whether they are those that Q and R hold already
bool KktSystem::gatherRows(const QpProblem& p, const Sides& sides) {
  const Index n = p.g.size(), m = p.a_lower.size();
  bool same = rows_factored_;
  Index count = 0;
  for (Index row = 0; row < m; ++row) {
    const Side side = sides[static_cast<std::size_t>(n + row)];
    if (side == kOff) continue;
    const auto k = static_cast<std::size_t>(count);
    if (count == n) {  // more rows than unknowns
      n_rows_ = n + 1;
      return false;
    }
    same = same && count < n_rows_ && rows_[k] == row;
    rows_[k] = row;
    row_side_[k] = side;
    for (Index j = 0; j < n; ++j) {
      const double a = p.A(row, j);
      same = same && At_(j, count) == a;
      At_(j, count) = a;
    }
    ++count;
  }
  same = same && count == n_rows_;
  n_rows_ = count;
  return same;
}

/// Q R = L^-1 A_wf' by modified Gram-Schmidt.
bool KktSystem::factorRows(double dependent_tolerance) {
  const Index n_f = n_free_, n_r = n_rows_;
  if (n_r > n_f) return false;
  for (Index j = 0; j < n_f; ++j) {  // V' = A_wf L^-T, column by column
    const Index unknown = order_[static_cast<std::size_t>(j)];
    auto column = Vt_.col(j).head(n_r);
    column = At_.row(unknown).head(n_r).transpose();
    if (j > 0) addProduct(-1.0, Vt_.block(0, 0, n_r, j), L_.row(j).head(j), column);
    column *= 1.0 / L_(j, j);
  }
  Q_.topLeftCorner(n_f, n_r) = Vt_.topLeftCorner(n_r, n_f).transpose();
  for (Index k = 0; k < n_r; ++k) norm_(k) = Q_.col(k).head(n_f).norm();
  for (Index k = 0; k < n_r; ++k) {
    auto q = Q_.col(k).head(n_f);
    const double norm = q.norm();
    if (!(norm > dependent_tolerance * norm_(k))) return false;
    q *= 1.0 / norm;
    R_(k, k) = norm;
    for (Index l = k + 1; l < n_r; ++l) {
      const double projection = q.dot(Q_.col(l).head(n_f));
      R_(k, l) = projection;
      Q_.col(l).head(n_f) -= projection * q;
    }
  }
  return true;
}

bool KktSystem::factor(const QpProblem& p, const Sides& sides, double dependent_tolerance) {
  if (!factorFree(p, sides)) return false;
  if (gatherRows(p, sides)) return true;
  rows_factored_ = n_rows_ <= n_free_ && factorRows(dependent_tolerance);
  return rows_factored_;
}

/// Errors of the KKT equations. @return whether they are down to rounding
bool KktSystem::residual(const QpProblem& p, QpResult& result) {
  const Index n_r = n_rows_;
  product(p.H, result.x, hx_);
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
  if (n_f > 0) L.solveInPlace(w);
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
  if (n_f > 0) L.transpose().solveInPlace(w);
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
  product(p.H, result.x, hx_);
  aty_.setZero();
  if (p.a_lower.size() > 0) transposedProduct(p.A, result.y_a, aty_);
}

}  // namespace fpc::qp
