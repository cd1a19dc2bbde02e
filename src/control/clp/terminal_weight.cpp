#include "control/clp/terminal_weight.hpp"

#include <cmath>

#include "control/clp/closed_loop_paradigm.hpp"

namespace fpc {

TerminalWeight::TerminalWeight(Eigen::Index n_x)
    : weight_(n_x, n_x), power_(n_x, n_x), scratch_(n_x, n_x), product_(n_x, n_x) {}

bool TerminalWeight::compute(MatrixRef Phi, MatrixRef Q, MatrixRef KRK) {
  constexpr int kDoublings = 60;       // enough for a spectral radius of 1 - 1e-15
  constexpr double kVanished = 1e-30;  // of Phi^(2^j); it squares, so this costs few doublings
  scratch_.noalias() = Q.lazyProduct(Phi);
  weight_.noalias() = Phi.transpose().lazyProduct(scratch_);
  weight_ += KRK;
  power_ = Phi;
  for (int j = 0; j < kDoublings; ++j) {
    const double size = power_.norm();
    if (!std::isfinite(size)) return false;
    scratch_.noalias() = weight_.lazyProduct(power_);
    product_.noalias() = power_.transpose().lazyProduct(scratch_);
    weight_ += product_;  // S_2n = S_n + Phi'^n S_n Phi^n
    if (size < kVanished) return weight_.allFinite();
    scratch_.noalias() = power_.lazyProduct(power_);
    power_.swap(scratch_);
  }
  return false;
}

bool terminalWeight(MatrixRef Phi, MatrixRef Q, MatrixRef KRK, Matrix& P) {
  TerminalWeight sum(Phi.rows());
  const bool stable = sum.compute(Phi, Q, KRK);
  P = sum.weight();
  return stable;
}

}  // namespace fpc
