#include "fmbpc/control/fmbpc/coincidence.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

constexpr double kSingular = 1e-12;  // relative size below which a pivot counts as rounding
constexpr int kWalked = 32;          // steps that are summed one by one

}  // namespace

CoincidenceGains::CoincidenceGains(Eigen::Index n_x, Eigen::Index n_u, Eigen::Index n_y)
    : last_output_(Vector::Unit(n_y, n_y - 1)),
      scale_(n_u),
      free_(n_y, n_x),
      sum_(n_y, n_x),
      next_(n_y, n_x),
      effect_(n_y, n_u),
      effect_size_(n_y, n_u),
      weighted_(n_y, n_u),
      normal_(n_u, n_u),
      gain_(n_u, n_y),
      move_gain_(n_u, n_u),
      beyond_(n_x),
      factor_(n_u) {}

void CoincidenceGains::walk(const AffineModel& model, int steps) {
  for (int i = 0; i < steps; ++i) {
    sum_ += free_;
    effect_.noalias() = free_ * model.B;
    effect_size_ += effect_.cwiseAbs();
    next_.noalias() = free_ * model.A;
    free_.swap(next_);
  }
}

// False, with nothing done, if powers of A overflow: then only walking keeps the outputs apart.
bool CoincidenceGains::leap(const AffineModel& model, int steps) {
  beyond_.compute(model.A, steps);
  if (!beyond_.power().allFinite() || !beyond_.sum().allFinite()) return false;
  next_.noalias() = free_ * beyond_.sum();
  sum_ += next_;
  effect_.noalias() = next_ * model.B;
  effect_size_ += effect_.cwiseAbs();
  next_.noalias() = free_ * beyond_.power();
  free_.swap(next_);
  return true;
}

void CoincidenceGains::predict(const AffineModel& model, int horizon, VectorRef weight_output) {
  free_ = model.C;
  for (Eigen::Index i = 0; i < free_.rows(); ++i)
    if (weight_output[i] == 0.0) free_.row(i).setZero();
  sum_.setZero();
  effect_size_.setZero();
  walk(model, std::min(horizon, kWalked));
  const int rest = horizon - kWalked;
  if (rest > 0 && !leap(model, rest)) walk(model, rest);
  effect_.noalias() = sum_ * model.B;
  // An effect that is nothing but the rounding of what cancelled is none.
  effect_ = (effect_.array().abs() > kSingular * effect_size_.array()).select(effect_, 0.0);
}

bool CoincidenceGains::computePublished(const AffineModel& model, int horizon) {
  predict(model, horizon, last_output_);
  const Eigen::Index last = effect_.rows() - 1;
  const double m2 = effect_(last, 0);
  gain_.setZero();
  move_gain_.setZero();
  if (!std::isfinite(m2) || m2 == 0.0) return false;
  gain_(0, last) = 1.0 / m2;
  return free_.allFinite() && sum_.allFinite();
}

bool CoincidenceGains::isIdle(Eigen::Index input) const {
  return (effect_.col(input).array() == 0.0).all();
}

bool CoincidenceGains::factor() {
  scale_ = normal_.diagonal().cwiseSqrt().cwiseInverse();
  if (!normal_.allFinite() || !scale_.allFinite()) return false;
  normal_ = scale_.asDiagonal() * normal_ * scale_.asDiagonal();
  factor_.compute(normal_);
  if (factor_.info() != Eigen::Success) return false;
  const double smallest = factor_.matrixLLT().diagonal().minCoeff();
  return smallest * smallest > kSingular;
}

bool CoincidenceGains::computeWeighted(const AffineModel& model, int horizon,
                                       VectorRef weight_output, VectorRef weight_move) {
  predict(model, horizon, weight_output);
  weighted_ = weight_output.cwiseSqrt().asDiagonal() * effect_;
  normal_.noalias() = weighted_.transpose() * weighted_;
  normal_.diagonal() += weight_move;
  gain_.setZero();
  move_gain_.setZero();
  if ((effect_.array() == 0.0).all() || !factor()) return false;
  for (Eigen::Index i = 0; i < gain_.cols(); ++i) {
    gain_.col(i) = weight_output[i] * scale_.cwiseProduct(effect_.row(i).transpose());
    factor_.solveInPlace(gain_.col(i));
  }
  gain_ = scale_.asDiagonal() * gain_;
  for (Eigen::Index i = 0; i < move_gain_.cols(); ++i) {
    move_gain_(i, i) = weight_move[i] * scale_[i];
    factor_.solveInPlace(move_gain_.col(i));
  }
  move_gain_ = scale_.asDiagonal() * move_gain_;
  return free_.allFinite() && sum_.allFinite() && gain_.allFinite();
}

}  // namespace fpc
