#include "papers/paper_loop.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {

Matrix paperReducedLoop(MatrixRef A, MatrixRef B, int horizon) {
  require(A.rows() == 2 && A.cols() == 2 && A(1, 0) == 0.0, "A", "[a b; 0 f]");
  require(B.rows() == 2 && B.cols() == 2 && B(1, 1) == 0.0 && B(0, 1) != 0.0 && B(1, 0) != 0.0, "B",
          "[m n; p 0] with n and p other than 0");
  PowerSum powers(2);
  powers.compute(A, horizon);
  const Matrix& power = powers.power();
  const double m2 = powers.sum().row(1).dot(B.col(0));
  // A^(H-1) B + S_(H-1) B [1 0; 1 0] counts u once for every sample, u' in all but the first.
  double m1 = powers.sum().row(0).dot(B.col(0)), scale = 1.0;
  if (horizon > 1) {
    PowerSum shorter(2);
    shorter.compute(A, horizon - 1);
    m1 += shorter.sum().row(0).dot(B.col(1));
    scale = shorter.power()(0, 0);
  }
  const Eigen::RowVector2d u = -power.row(1) / m2;
  const Eigen::RowVector2d previous = (-power.row(0) - m1 * u) / (scale * B(0, 1));
  return A + B.col(0) * u + B.col(1) * previous;
}

double paperSecondEigenvalue(double f, int horizon) {
  require(horizon >= 1, "coincidence_steps", "an integer >= 1");
  double shorter = 0.0, sum = 0.0;
  for (int i = 0; i < horizon; ++i) {
    shorter = sum;
    sum = 1.0 + f * sum;
  }
  return f * shorter / sum;
}

LinearModel paperModel(MatrixRef A, MatrixRef B) {
  require(A.rows() == 2 && A.cols() == 2 && B.rows() == 2 && B.cols() == 2, "A, B", "2 x 2");
  LinearModel model{AffineModel(3, 1, 2), Matrix::Zero(1, 3)};
  model.affine.A.topLeftCorner(2, 2) = A;
  model.affine.A.col(2).head(2) = B.col(1);
  model.affine.B.col(0) << B(0, 0), B(1, 0), 1.0;
  model.affine.C.leftCols(2).setIdentity();
  model.previous_input(0, 2) = 1.0;
  return model;
}

}  // namespace fpc
