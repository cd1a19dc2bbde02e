// The inputs of one sample of a plan: the least of a small quadratic inside bounds and move limits.
#include <algorithm>
#include <cmath>

#include "control/fmbpc/input_limited_ilqr.hpp"

namespace fpc {
namespace {

constexpr double kFlat = 1e-12;  // slope that is none, relative

}  // namespace

/// Into wish_ the least of 1/2 x' Quu x + Qu' x with the fixed inputs where wish_ has them.
bool InputLimitedIlqr::solveFree() {
  free_Quu_ = Quu_;
  input_ = -Qu_;
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    if (!fixed_[static_cast<std::size_t>(a)]) continue;
    input_ -= wish_[a] * Quu_.col(a);
    free_Quu_.row(a).setZero();
    free_Quu_.col(a).setZero();
    free_Quu_(a, a) = 1.0;
  }
  for (Eigen::Index a = 0; a < n_u_; ++a)
    if (fixed_[static_cast<std::size_t>(a)]) input_[a] = wish_[a];
  factor_.compute(free_Quu_);
  if (factor_.info() != Eigen::Success) return false;
  factor_.solveInPlace(input_);
  wish_ = input_;
  return true;
}

/// Puts every free input that is out of its limits on them. False if there is none.
bool InputLimitedIlqr::fixMore() {
  bool more = false;
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    wish_[a] = std::clamp(input_[a], lower_[a], upper_[a]);
    if (wish_[a] == input_[a] || fixed_[static_cast<std::size_t>(a)]) continue;
    fixed_[static_cast<std::size_t>(a)] = more = true;
  }
  return more;
}

/// Frees the fixed input that would gain most by moving inwards. False if none would.
bool InputLimitedIlqr::release() {
  Eigen::Index best = -1;
  double gain = 0.0;
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    if (!fixed_[static_cast<std::size_t>(a)] || lower_[a] == upper_[a]) continue;
    const double slope = Quu_.row(a).dot(wish_) + Qu_[a];
    const double inwards = wish_[a] == lower_[a] ? -slope : slope;
    if (inwards <= kFlat * (1.0 + std::abs(Qu_[a])) || inwards <= gain) continue;
    gain = inwards;
    best = a;
  }
  if (best >= 0) fixed_[static_cast<std::size_t>(best)] = false;
  return best >= 0;
}

/// Whether input a of sample i stands at its move limit, so that it goes where u(i-1) goes.
bool InputLimitedIlqr::atMoveLimit(Eigen::Index i, Eigen::Index a) const {
  const double before = states_(model_.inputState(a, 1), i), move = limits_.move[a];
  if (wish_[a] == upper_[a] && before + move < limits_.upper[a]) return true;
  return wish_[a] == lower_[a] && before - move > limits_.lower[a];
}

/// The best input of sample i for the cost to go, those at a limit fixed there.
bool InputLimitedIlqr::chooseInput(Eigen::Index i) {
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    const double before = states_(model_.inputState(a, 1), i);
    lower_[a] = std::max(limits_.lower[a], before - limits_.move[a]) - inputs_(a, i);
    upper_[a] = std::min(limits_.upper[a], before + limits_.move[a]) - inputs_(a, i);
    lower_[a] = std::min(lower_[a], upper_[a]);
    fixed_[static_cast<std::size_t>(a)] = false;
  }
  for (Eigen::Index round = 0; round < 4 * n_u_ + 1; ++round) {
    if (!solveFree()) return false;
    if (!fixMore() && !release()) break;
  }
  step_.col(i) = wish_;
  for (Eigen::Index a = 0; a < n_u_; ++a)
    bounds_[static_cast<std::size_t>(a)] = !fixed_[static_cast<std::size_t>(a)] ? Bound::kFree
                                           : atMoveLimit(i, a)                  ? Bound::kMoves
                                                                                : Bound::kFixed;
  return wish_.allFinite();
}

/// The feedback K of sample i, behind chooseInput().
bool InputLimitedIlqr::findFeedback(Eigen::Index i) {
  Matrix& K = K_[static_cast<std::size_t>(i)];
  K = -Qux_;
  for (Eigen::Index a = 0; a < n_u_; ++a) {
    if (bounds_[static_cast<std::size_t>(a)] == Bound::kFree) continue;
    K.row(a).setZero();
    if (bounds_[static_cast<std::size_t>(a)] != Bound::kMoves) continue;
    const Eigen::Index before = model_.inputState(a, 1);
    K(a, before) = 1.0;
    for (Eigen::Index b = 0; b < n_u_; ++b)
      if (bounds_[static_cast<std::size_t>(b)] == Bound::kFree) K(b, before) -= Quu_(b, a);
  }
  const double root = factor_.matrixLLT()(0, 0);
  if (n_u_ == 1) (K /= root) /= root;  // what a solver's call does, at a tenth of the cost
  for (Eigen::Index j = 0; j < n_x_ && n_u_ > 1; ++j) factor_.solveInPlace(K.col(j));
  return K.allFinite();
}

}  // namespace fpc
