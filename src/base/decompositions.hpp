// Eigen's costly decompositions, compiled once: each takes 5 to 10 s in every file that makes one.
#pragma once

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Without vectors.
Eigen::EigenSolver<Matrix> eigenOf(MatrixRef A);
Eigen::SelfAdjointEigenSolver<Matrix> symmetricEigenOf(MatrixRef A,
                                                       int options = Eigen::ComputeEigenvectors);
Eigen::JacobiSVD<Matrix> svdOf(MatrixRef A, unsigned options = 0);
Eigen::ColPivHouseholderQR<Matrix> pivotedQrOf(MatrixRef A);
/// Of A x = b by least squares.
Vector solvedBy(const Eigen::ColPivHouseholderQR<Matrix>& A, const Vector& b);
inline Vector solvedByPivotedQr(MatrixRef A, const Vector& b) {
  return solvedBy(pivotedQrOf(A), b);
}

}  // namespace fpc
