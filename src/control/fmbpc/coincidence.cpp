#include "control/fmbpc/coincidence.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

constexpr double kSingular = 1e-12;  // relative size below which a pivot counts as rounding
constexpr int kWalked = 32;          // horizons that are summed step by step
constexpr int kStart = 8;            // of longer ones fewer than these steps
constexpr Eigen::Index kSmall = 20;  // rows and columns below which Eigen multiplies by definition

/// to = a b by definition, the sums' length known to the compiler or, for 0, not.
template <Eigen::Index kDepth>
void multiplyOf(const Matrix& a, const Matrix& b, Matrix& to) {
  const Eigen::Index rows = a.rows(), depth = kDepth > 0 ? kDepth : a.cols();
  const double *factor = b.data(), *end = factor + depth * b.cols();
  for (double* out = to.data(); factor != end; factor += depth, out += rows) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double* entry = a.data() + i;
      double sum = 0.0;
      for (Eigen::Index k = 0; k < depth; ++k) sum += entry[k * rows] * factor[k];
      out[i] = sum;
    }
  }
}

/// to = a b: the same bits as Eigen's below kSmall, without its way there.
void multiply(const Matrix& a, const Matrix& b, Matrix& to) {
  if (a.rows() + a.cols() + b.cols() >= kSmall) {
    to.noalias() = a * b;
    return;
  }
  switch (a.cols()) {
    case 2:
      return multiplyOf<2>(a, b, to);
    case 3:
      return multiplyOf<3>(a, b, to);
    case 4:
      return multiplyOf<4>(a, b, to);
    case 6:
      return multiplyOf<6>(a, b, to);
    default:
      return multiplyOf<0>(a, b, to);
  }
}

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
      power_(n_x, n_x),
      square_(n_x, n_x),
      factor_(n_u) {}

void CoincidenceGains::walk(const AffineModel& model, int steps) {
  for (int i = 0; i < steps; ++i) {
    sum_ += free_;
    multiply(free_, model.B, effect_);
    effect_size_ += effect_.cwiseAbs();
    multiply(free_, model.A, next_);
    free_.swap(next_);
  }
}

/// From n steps to 2 n, and to 2 n + 1 if `odd`; power_ is A^n and goes along unless `last`.
void CoincidenceGains::twice(const AffineModel& model, bool odd, bool last) {
  multiply(sum_, power_, next_);
  sum_ += next_;
  multiply(next_, model.B, effect_);
  effect_size_ += effect_.cwiseAbs();
  multiply(free_, power_, next_);
  free_.swap(next_);
  if (odd) walk(model, 1);
  if (last) return;
  multiply(power_, power_, square_);
  power_.swap(square_);
  if (!odd) return;
  multiply(power_, model.A, square_);
  power_.swap(square_);
}

void CoincidenceGains::begin(const AffineModel& model, VectorRef weight_output) {
  free_ = model.C;
  for (Eigen::Index i = 0; i < free_.rows(); ++i)
    if (weight_output[i] == 0.0) free_.row(i).setZero();
  sum_.setZero();
  effect_size_.setZero();
}

// False if powers of A overflow: then only walking keeps the outputs apart.
bool CoincidenceGains::leap(const AffineModel& model, int horizon) {
  int bits = 0;
  while ((horizon >> bits) >= kStart) ++bits;
  const int start = horizon >> bits;
  walk(model, start);
  power_ = model.A;
  for (int i = 1; i < start; ++i) {
    multiply(power_, model.A, square_);
    power_.swap(square_);
  }
  for (int bit = bits - 1; bit >= 0; --bit) twice(model, (horizon >> bit) % 2 == 1, bit == 0);
  return power_.allFinite();
}

void CoincidenceGains::predict(const AffineModel& model, int horizon, VectorRef weight_output) {
  begin(model, weight_output);
  if (horizon <= kWalked) {
    walk(model, horizon);
  } else if (!leap(model, horizon)) {
    begin(model, weight_output);
    walk(model, horizon);
  }
  multiply(sum_, model.B, effect_);
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
