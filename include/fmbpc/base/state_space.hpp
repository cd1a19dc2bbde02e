// Affine state-space models and the sums of powers that predictive laws need, without ever
// inverting (A - I).
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// x(k+1) = A x + B u + g,  y = C x.
/// Symbols: A n_x n_x, B n_x n_u, C n_y n_x, g n_x
struct AffineModel {
  Matrix A, B, C;
  Vector g;

  AffineModel() = default;
  AffineModel(Eigen::Index n_x, Eigen::Index n_u, Eigen::Index n_y)
      : A(Matrix::Zero(n_x, n_x)),
        B(Matrix::Zero(n_x, n_u)),
        C(Matrix::Zero(n_y, n_x)),
        g(Vector::Zero(n_x)) {}
};

/// A^H and S_H = sum_{i<H} A^i by doubling; exact for singular (A - I). Allocates once, at
/// construction.
class PowerSum {
 public:
  explicit PowerSum(Eigen::Index n_x);
  /// @throws InputError if horizon < 1 or A is not n_x n_x.
  void compute(MatrixRef A, int horizon);
  const Matrix& power() const { return power_; }  ///< A^H
  const Matrix& sum() const { return sum_; }      ///< I + A + ... + A^(H-1)

 private:
  Matrix power_, sum_, scratch_;
};

}  // namespace fpc
