// Row-wise QR: a block of rows is stacked under the triangle and folded into it by Householder
// reflections.
#include "optim/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/decompositions.hpp"
#include "optim/qp_kernels.hpp"

namespace fpc {
namespace {

constexpr Eigen::Index kSmallestBlock = 64;
constexpr double kRankTolerance = 1e-12;  // of the largest pivot, columns scaled to length 1
constexpr int kPowerIterations =
    40;  // a condition number needs no more than its order of magnitude

/// Lengths of the columns; 1 for columns of zeros.
Vector columnLengths(const Matrix& matrix) {
  Vector lengths = matrix.colwise().norm();
  for (double& length : lengths)
    if (!(length > 0.0)) length = 1.0;
  return lengths;
}

/// Largest singular value of what `apply` does (symmetric, positive), by power iteration.
template <typename Apply>
double largestEigenvalue(Eigen::Index n, const Apply& apply) {
  Vector direction = Vector::LinSpaced(n, 1.0, 2.0).normalized();
  double length = 0.0;
  for (int i = 0; i < kPowerIterations; ++i) {
    const Vector next = apply(direction);
    length = next.norm();
    if (!(length > 0.0) || !std::isfinite(length)) break;
    direction = next / length;
  }
  return length;
}

void judge(const Matrix& scaled, LeastSquaresSolution& solution) {
  Eigen::ColPivHouseholderQR<Matrix> qr = pivotedQrOf(scaled);
  qr.setThreshold(kRankTolerance);
  solution.rank = qr.rank();
  solution.condition = std::numeric_limits<double>::infinity();
  const Eigen::Index n = scaled.cols();
  if (n == 0 || solution.rank < n) return;
  const Matrix square = qr.matrixR().topRows(n);
  const auto R = square.triangularView<Eigen::Upper>();
  const double largest =
      largestEigenvalue(n, [&](const Vector& v) { return Vector(R.transpose() * Vector(R * v)); });
  const double inverse = largestEigenvalue(
      n, [&](const Vector& v) { return Vector(R.solve(R.transpose().solve(v))); });
  solution.condition = std::sqrt(largest) * std::sqrt(inverse);
}

}  // namespace

LeastSquares::LeastSquares(Eigen::Index unknowns)
    : n_(unknowns),
      stack_(Matrix::Zero(n_ + 1 + std::max(kSmallestBlock, 2 * n_), n_ + 1)),
      shares_(n_) {}

void LeastSquares::add(VectorRef x, double y, double weight) {
  if (!(weight > 0.0)) return;
  const double root = std::sqrt(weight);
  const Eigen::Index row = n_ + 1 + filled_;
  stack_.row(row).head(n_) = root * x.transpose();
  stack_(row, n_) = root * y;
  ++rows_;
  if (n_ + 1 + ++filled_ == stack_.rows()) fold();
}

/// Reflections that take one column of the block each into the triangle above: of its rows they
/// touch one only.
void LeastSquares::fold() {
  if (filled_ == 0) return;
  auto block = stack_.middleRows(n_ + 1, filled_);
  for (Eigen::Index j = 0; j <= n_; ++j) {
    auto column = block.col(j);
    const double tail = column.squaredNorm(), top = stack_(j, j);
    if (!(tail > std::numeric_limits<double>::min())) {
      column.setZero();
      continue;
    }
    const Eigen::Index right = n_ - j;
    const double length = std::copysign(std::sqrt(top * top + tail), top);
    stack_(j, j) = -length;
    column /= top + length;  // the reflection is I - (1 + top / length) v v', v = (1, column)
    if (right > 0) {
      auto row = stack_.row(j).tail(right);
      Eigen::Map<Vector> share(shares_.data(), right);
      qp::transposedProduct(block.rightCols(right), column, share);
      share = (1.0 + top / length) * (share + row.transpose());
      row -= share.transpose();
      qp::subtractOuter(column.data(), filled_, share.data(), right, block.rightCols(right).data(),
                        stack_.outerStride());
    }
    column.setZero();
  }
  filled_ = 0;
}

Matrix LeastSquares::metric() const {
  const auto known = stack_.topLeftCorner(n_ + 1 + filled_, n_);
  return known.transpose() * known;
}

LeastSquaresSolution LeastSquares::solve(double ridge) {
  fold();
  const Matrix triangle = stack_.topLeftCorner(n_ + 1, n_);
  const Vector lengths = columnLengths(triangle);
  const Matrix scaled = triangle * lengths.cwiseInverse().asDiagonal();
  LeastSquaresSolution solution;
  judge(scaled, solution);
  Matrix system = Matrix::Zero(2 * n_ + 1, n_);
  system.topRows(n_ + 1) = scaled;
  system.bottomRows(n_).diagonal() = std::sqrt(ridge) * lengths.cwiseInverse();
  Vector right = Vector::Zero(2 * n_ + 1);
  right.head(n_ + 1) = stack_.col(n_).head(n_ + 1);
  solution.theta = Vector::Zero(n_);
  if (system.isZero(0.0)) return solution;  // of which Eigen 3.3 makes NaN
  Eigen::ColPivHouseholderQR<Matrix> qr = pivotedQrOf(system);
  qr.setThreshold(kRankTolerance);
  solution.theta = lengths.cwiseInverse().asDiagonal() * solvedBy(qr, right);
  return solution;
}

}  // namespace fpc
