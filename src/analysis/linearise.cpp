#include "analysis/linearise.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kDifference = 6e-6;  // cube root of the rounding error

}  // namespace

Matrix jacobian(const VectorFunction& function, VectorRef x, Eigen::Index m, VectorRef size) {
  require(size.size() == x.size() && (size.array() > 0.0).all(), "size",
          "one number > 0 per variable");
  Matrix J(m, x.size());
  Vector point = x, ahead(m), behind(m);
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double h = kDifference * size[j];
    point[j] = x[j] + h;
    const double upper = point[j];
    function(point, ahead);
    point[j] = x[j] - h;
    const double lower = point[j];
    function(point, behind);
    point[j] = x[j];
    J.col(j) = (ahead - behind) / (upper - lower);
  }
  return J;
}

SampledMatrices sampleAndHold(MatrixRef A, MatrixRef B, double sample_time) {
  require(A.rows() == A.cols() && B.rows() == A.rows(), "A, B", "n_x n_x and n_x n_u");
  require(sample_time > 0.0 && std::isfinite(sample_time), "sample_time", "a finite number > 0");
  const Eigen::Index n = A.rows(), n_u = B.cols();
  Matrix both = Matrix::Zero(n + n_u, n + n_u);
  both.topLeftCorner(n, n) = A * sample_time;
  both.topRightCorner(n, n_u) = B * sample_time;
  const Matrix power = both.exp();
  return {power.topLeftCorner(n, n), power.topRightCorner(n, n_u)};
}

Matrix sampledLocalLoop(MatrixRef A, MatrixRef B, double sample_time, MatrixRef L_now,
                        MatrixRef L_before) {
  const SampledMatrices sampled = sampleAndHold(A, B, sample_time);
  const Eigen::Index n = A.rows();
  require(L_now.rows() == B.cols() && L_now.cols() == n && L_before.rows() == B.cols() &&
              L_before.cols() == n,
          "L_now, L_before", "n_u n_x");
  Matrix map = Matrix::Zero(2 * n, 2 * n);
  map.topLeftCorner(n, n) = sampled.A + sampled.B * L_now;
  map.topRightCorner(n, n) = sampled.B * L_before;
  map.bottomLeftCorner(n, n).setIdentity();
  return map;
}

}  // namespace fpc
