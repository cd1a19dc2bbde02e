#include "fmbpc/base/state_space.hpp"

#include "fmbpc/base/input_error.hpp"

namespace fpc {

PowerSum::PowerSum(Eigen::Index n_x)
    : power_(Matrix::Identity(n_x, n_x)), sum_(Matrix::Zero(n_x, n_x)), scratch_(n_x, n_x) {}

void PowerSum::compute(MatrixRef A, int horizon) {
  require(horizon >= 1, "horizon", "an integer >= 1");
  require(A.rows() == power_.rows() && A.cols() == power_.cols(), "A",
          "a square matrix of the size given at construction");
  power_.setIdentity();
  sum_.setZero();
  int bit = 1;
  while (bit <= horizon / 2) bit *= 2;
  for (; bit > 0; bit /= 2) {  // from n to 2 n, then to 2 n + 1 where the bit is set
    scratch_.noalias() = power_ * sum_;
    sum_ += scratch_;  // S_2n = S_n + A^n S_n
    scratch_.noalias() = power_ * power_;
    power_.swap(scratch_);
    if (horizon & bit) {
      sum_ += power_;  // S_(n+1) = S_n + A^n
      scratch_.noalias() = power_ * A;
      power_.swap(scratch_);
    }
  }
}

}  // namespace fpc
