// Row-wise QR: a block of rows is stacked under the triangle and folded into it by Householder
// reflections.
#include "fmbpc/optim/least_squares.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

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
  Eigen::ColPivHouseholderQR<Matrix> qr(scaled);
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
    : n_(unknowns), stack_(Matrix::Zero(n_ + 1 + std::max(kSmallestBlock, 2 * n_), n_ + 1)) {}

void LeastSquares::add(VectorRef x, double y, double weight) {
  if (!(weight > 0.0)) return;
  const double root = std::sqrt(weight);
  const Eigen::Index row = n_ + 1 + filled_;
  stack_.row(row).head(n_) = root * x.transpose();
  stack_(row, n_) = root * y;
  ++rows_;
  if (n_ + 1 + ++filled_ == stack_.rows()) fold();
}

void LeastSquares::fold() {
  if (filled_ == 0) return;
  Eigen::HouseholderQR<Eigen::Ref<Matrix>> qr(stack_);
  for (Eigen::Index j = 0; j <= n_; ++j) stack_.col(j).tail(stack_.rows() - j - 1).setZero();
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
  Eigen::ColPivHouseholderQR<Matrix> qr(system);
  qr.setThreshold(kRankTolerance);
  solution.theta = lengths.cwiseInverse().asDiagonal() * qr.solve(right);
  return solution;
}

}  // namespace fpc
