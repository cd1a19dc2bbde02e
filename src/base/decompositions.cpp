#include "base/decompositions.hpp"

namespace fpc {

Eigen::EigenSolver<Matrix> eigenOf(MatrixRef A) { return Eigen::EigenSolver<Matrix>(A, false); }

Eigen::SelfAdjointEigenSolver<Matrix> symmetricEigenOf(MatrixRef A, int options) {
  return Eigen::SelfAdjointEigenSolver<Matrix>(A, options);
}

Eigen::JacobiSVD<Matrix> svdOf(MatrixRef A, unsigned options) {
  return Eigen::JacobiSVD<Matrix>(A, options);
}

Eigen::ColPivHouseholderQR<Matrix> pivotedQrOf(MatrixRef A) {
  return Eigen::ColPivHouseholderQR<Matrix>(A);
}

Vector solvedBy(const Eigen::ColPivHouseholderQR<Matrix>& A, const Vector& b) { return A.solve(b); }

}  // namespace fpc
