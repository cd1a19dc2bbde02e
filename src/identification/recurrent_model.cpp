#include "identification/recurrent_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fpc {

using Eigen::Index;

double RecurrentShape::output(double x1) const {
  const double y = absolute ? std::abs(x1) : x1;
  return lower < upper ? std::clamp(y, lower, upper) : y;
}

RecurrentStep::RecurrentStep(const RecurrentShape& shape)
    : shape_(shape),
      phi_(shape.states + shape.exogenous),
      terms_(shape.terms()),
      weights_(Vector::Ones(shape.rules)),
      log_(shape.rules),
      value_(shape.rows()),
      local_(shape.rows(), shape.rules),
      away_(static_cast<Index>(shape.antecedents.size()), shape.rules),
      inverse_(away_),
      log_width_(Vector::Constant(shape.setCount(), std::numeric_limits<double>::quiet_NaN())),
      jacobian_(Matrix::Zero(shape.states, shape.states)) {
  terms_[shape.terms() - 1] = 1.0;
}

void RecurrentStep::weigh(VectorRef p) {
  if (shape_.rules == 1) return;
  const Index n_z = away_.rows();
  if (p.tail(log_width_.size()) != log_width_) {
    log_width_ = p.tail(log_width_.size());
    Eigen::Map<Vector>(inverse_.data(), inverse_.size()) = (-2.0 * log_width_.array()).exp();
  }
  for (Index i = 0; i < shape_.rules; ++i) {
    double sum = 0.0;
    for (Index j = 0; j < n_z; ++j) {
      away_(j, i) = phi_[shape_.antecedents[static_cast<std::size_t>(j)]] - p[shape_.centre(i) + j];
      sum -= 0.5 * away_(j, i) * away_(j, i) * inverse_(j, i);
    }
    log_[i] = sum;
  }
  weights_ = (log_.array() - log_.maxCoeff()).exp();
  weights_ /= weights_.sum();
}

void RecurrentStep::predict(VectorRef p, VectorRef x, VectorRef v, Eigen::Ref<Vector> next) {
  const Index n = shape_.states, q = shape_.terms();
  phi_.head(n) = x;
  phi_.tail(shape_.exogenous) = v;
  for (Index j = 0; j + 1 < q; ++j)
    terms_[j] = phi_[shape_.regressors[static_cast<std::size_t>(j)]];
  weigh(p);
  for (Index i = 0; i < shape_.rules; ++i)
    for (Index r = 0; r < shape_.rows(); ++r)
      local_(r, i) = terms_.dot(p.segment(shape_.at(i, r), q));
  value_.noalias() = local_ * weights_;
  next.head(shape_.rows()) = value_;
  if (shape_.companion && n > 1) next.tail(n - 1) = x.head(n - 1);
}

void RecurrentStep::slopes(VectorRef p) {
  const Index n = shape_.states, q = shape_.terms();
  jacobian_.setZero();
  for (Index j = 0; j + 1 < q; ++j) {
    const Index source = shape_.regressors[static_cast<std::size_t>(j)];
    if (source >= n) continue;
    for (Index i = 0; i < shape_.rules; ++i)
      for (Index r = 0; r < shape_.rows(); ++r)
        jacobian_(r, source) += weights_[i] * p[shape_.at(i, r) + j];
  }
  for (Index j = 0; shape_.rules > 1 && j < away_.rows(); ++j) {
    const Index source = shape_.antecedents[static_cast<std::size_t>(j)];
    if (source >= n) continue;
    for (Index i = 0; i < shape_.rules; ++i) {
      const double pull = -weights_[i] * away_(j, i) * inverse_(j, i);
      for (Index r = 0; r < shape_.rows(); ++r)
        jacobian_(r, source) += pull * (local_(r, i) - value_[r]);
    }
  }
  if (shape_.companion)
    for (Index r = 1; r < n; ++r) jacobian_(r, r - 1) = 1.0;
}

void RecurrentStep::addDirect(VectorRef /*p*/, Index row, Eigen::Ref<Matrix> s, Index target) {
  const Index q = shape_.terms();
  for (Index i = 0; i < shape_.rules; ++i) {
    for (Index j = 0; j < q; ++j) s(target, shape_.at(i, row) + j) += weights_[i] * terms_[j];
    if (shape_.rules == 1) continue;
    const double gain = weights_[i] * (local_(row, i) - value_[row]);
    for (Index j = 0; j < away_.rows(); ++j) {
      const double pull = gain * away_(j, i) * inverse_(j, i);
      s(target, shape_.centre(i) + j) += pull;
      s(target, shape_.logWidth(i) + j) += pull * away_(j, i);
    }
  }
}

void RecurrentStep::differentiate(VectorRef p, Eigen::Ref<Matrix> sensitivity) {
  slopes(p);
  moved_.noalias() = jacobian_.lazyProduct(sensitivity);
  sensitivity = moved_;
  for (Index r = 0; r < shape_.rows(); ++r) addDirect(p, r, sensitivity, r);
}

void RecurrentStep::direct(VectorRef p, Eigen::Ref<Vector> gradient) {
  moved_.setZero(1, gradient.size());
  addDirect(p, 0, moved_, 0);
  gradient = moved_.row(0).transpose();
}

}  // namespace fpc
