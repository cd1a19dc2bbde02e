// The KKT system of one working set. With the unknowns at a bound removed, v = L'x_f solves a
// least-squares problem:
//   v = w + Q (R^-T b - Q'w),  R y = R^-T b - Q'w,  w = L^-1 r_f   (null-space form of
//   goldfarb1983, 3).
// Answers are refined on the original data, so they do not depend on how the working set was found.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "optim/qp_kernels.hpp"
#include "optim/qp_workspace.hpp"

namespace fpc::qp {
namespace {

constexpr double kPivotTolerance =
    1e-14;                   // of H_ii: below it H is not positive definite in this arithmetic
constexpr Index kStrip = 8;  // numbers in a cache line

bool sameBits(const double* a, const double* b, Index count) {
  return std::memcmp(a, b, static_cast<std::size_t>(count) * sizeof(double)) == 0;
}

bool isDiagonal(const Matrix& H) {
  for (Index j = 0; j < H.cols(); ++j) {
    for (Index i = 0; i < H.rows(); ++i)
      if (i != j && H(i, j) != 0.0) return false;
  }
  return true;
}

}  // namespace

void KktSystem::resize(Index n, Index m) {
  const auto size = static_cast<std::size_t>(n);
  for (Matrix* M : {&H_, &L_, &At_, &Vt_, &Q_, &R_}) M->setZero(n, n);
  for (Vector* v : {&y_, &hx_, &aty_, &residual_free_, &residual_row_, &work_, &work_row_, &norm_,
                    &shift_, &least_pivot_})
    v->setZero(n);
  row_scale_.setZero(m);
  row_largest_.setZero(m);
  shift_size_ = 0.0;
  order_.assign(size, 0);
  fixed_.assign(size, 0);
  rows_.assign(size, 0);
  row_side_.assign(size, kOff);
  n_free_ = n_rows_ = 0;
  factored_ = rows_factored_ = complete_ = definite_ = diagonal_ = false;
}

void KktSystem::setHessian(const Matrix& H) {
  if (sameBits(H.data(), H_.data(), H.size())) return;
  H_ = H;
  diagonal_ = isDiagonal(H);
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
    if (j > 0 && !diagonal_)
      addProduct(-1.0, L_.block(first, 0, count, j), L_.row(j).head(j), column);
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

bool KktSystem::choleskyOfFree() {
  for (Index j = 0; j < n_free_; ++j) {
    const Index unknown = order_[static_cast<std::size_t>(j)];
    least_pivot_(j) = kPivotTolerance * (H_(unknown, unknown) + shift_(unknown));
  }
  return choleskyInPlace(L_.data(), L_.rows(), n_free_, least_pivot_.data());
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
  factored_ = diagonal_ ? cholesky(0, free, 0, free) : choleskyOfFree();
  return factored_;
}

bool KktSystem::complete() {
  if (complete_) return true;
  if (!factored_) return false;
  const Index n = H_.rows();
  for (Index j = 0; j < n && n_free_ < n; ++j) {
    const double* column = H_.data() + order_[static_cast<std::size_t>(j)] * n;
    for (Index i = std::max(j, n_free_); i < n; ++i)
      L_(i, j) = column[order_[static_cast<std::size_t>(i)]];
    if (j >= n_free_) L_(j, j) += shift_(order_[static_cast<std::size_t>(j)]);
  }
  complete_ =
      n_free_ == n || (cholesky(0, n_free_, n_free_, n) && cholesky(n_free_, n, n_free_, n));
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
    ++count;
  }
  same = same && count == n_rows_;
  // In strips of columns of A, so that neither A nor its copy is read against the grain.
  for (Index strip = 0; strip < n; strip += kStrip) {
    const Index end = std::min(strip + kStrip, n);
    for (Index k = 0; k < count; ++k) {
      const Index row = rows_[static_cast<std::size_t>(k)];
      for (Index j = strip; j < end; ++j) {
        const double a = p.A(row, j);
        same = same && At_(j, k) == a;
        At_(j, k) = a;
      }
    }
  }
  n_rows_ = count;
  return same;
}

/// Q = L^-1 A_wf'
void KktSystem::transformRows() {
  const Index n_f = n_free_, n_r = n_rows_;
  if (diagonal_) {
    for (Index k = 0; k < n_r; ++k) {
      for (Index j = 0; j < n_f; ++j)
        Q_(j, k) = At_(order_[static_cast<std::size_t>(j)], k) / L_(j, j);
    }
    return;
  }
  for (Index j = 0; j < n_f; ++j) {  // V' = A_wf L^-T, column by column
    const Index unknown = order_[static_cast<std::size_t>(j)];
    auto column = Vt_.col(j).head(n_r);
    column = At_.row(unknown).head(n_r).transpose();
    if (j > 0) addProduct(-1.0, Vt_.block(0, 0, n_r, j), L_.row(j).head(j), column);
    column *= 1.0 / L_(j, j);
  }
  Q_.topLeftCorner(n_f, n_r) = Vt_.topLeftCorner(n_r, n_f).transpose();
}

/// Q R = L^-1 A_wf' by modified Gram-Schmidt.
bool KktSystem::factorRows(double dependent_tolerance) {
  const Index n_f = n_free_, n_r = n_rows_;
  if (n_r > n_f) return false;
  transformRows();
  for (Index k = 0; k < n_r; ++k) norm_(k) = Q_.col(k).head(n_f).norm();
  for (Index k = 0; k < n_r; ++k) {
    auto q = Q_.col(k).head(n_f);
    const double norm = q.norm();
    if (!(norm > dependent_tolerance * norm_(k))) return false;
    q *= 1.0 / norm;
    R_(k, k) = norm;
    const Index rest = n_r - k - 1;
    if (rest == 0) break;
    const auto columns = Q_.block(0, k + 1, n_f, rest);
    transposedProduct(columns, q, work_row_);
    R_.row(k).segment(k + 1, rest) = work_row_.head(rest).transpose();
    subtractOuter(q.data(), n_f, work_row_.data(), rest, Q_.col(k + 1).data(), Q_.rows());
  }
  return true;
}

bool KktSystem::factor(const QpProblem& p, const Sides& sides, double dependent_tolerance) {
  if (!factorFree(p, sides)) return false;
  if (gatherRows(p, sides)) return true;
  rows_factored_ = n_rows_ == 0 || (n_rows_ <= n_free_ && factorRows(dependent_tolerance));
  return rows_factored_;
}

}  // namespace fpc::qp
