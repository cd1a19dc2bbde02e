// Short names for the matrices that every room uses.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "fmbpc/base/eigen_iteration.hpp"

namespace fpc {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using VectorRef = Eigen::Ref<const Vector>;
using MatrixRef = Eigen::Ref<const Matrix>;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();  ///< also: nobody knows it

/// All elements of a matrix as one vector, column by column: the matrix itself, not a copy.
inline Eigen::Map<Vector> flat(Matrix& matrix) { return {matrix.data(), matrix.size()}; }
inline Eigen::Map<const Vector> flat(const Matrix& matrix) {
  return {matrix.data(), matrix.size()};
}

}  // namespace fpc
