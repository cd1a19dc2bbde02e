// Least squares of any number of rows in the memory of one triangle: rows come in blocks, QR keeps
// what they say.
#pragma once

#include <cstdint>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct LeastSquaresSolution {
  Vector theta;         ///< n
  double condition{};   ///< of the matrix with its columns scaled to length 1; infinite if
                        ///< rank-deficient
  Eigen::Index rank{};  ///< of the same matrix, before the ridge
};

/// Collects rows [x' y] into the triangle R of their QR factorisation (never the normal equations).
/// Source: golub2013, sec. 6.5.4 (QR updating by rows).
class LeastSquares {
 public:
  explicit LeastSquares(Eigen::Index unknowns);
  /// Adds sqrt(weight) [x' y]; rows of weight 0 are left out.
  void add(VectorRef x, double y, double weight = 1.0);
  std::uint64_t rows() const { return rows_; }  ///< of weight > 0
  /// Minimises sum weight (y - theta' x)^2 + ridge |theta|^2. Columns are scaled first; directions
  /// that neither the data nor the ridge determine get 0. May be called at any time; more rows may
  /// follow.
  LeastSquaresSolution solve(double ridge = 0.0);
  Matrix metric() const;  ///< sum weight x x' (n x n)

 private:
  void fold();

  Eigen::Index n_, filled_{};
  Matrix stack_;  // the triangle on top, the rows not yet folded in below
  Vector shares_;
  std::uint64_t rows_{};
};

}  // namespace fpc
