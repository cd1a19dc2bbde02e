#include "estimation/disturbance_observer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/require_numbers.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kLeastNoise = 1e-6;  // of the variance of d's change: keeps S regular

/// P = A P A', in the order of the whole sums, which most of A's elements, 0, add nothing to.
void multiplyBothSides(const Matrix& A, Matrix& P, Matrix& PA) {
  PA.setZero();
  for (Index k = 0; k < A.cols(); ++k)
    for (Index j = 0; j < A.rows(); ++j)
      if (A(j, k) != 0.0) PA.col(j) += A(j, k) * P.col(k);
  P.setZero();
  for (Index k = 0; k < A.cols(); ++k)
    for (Index i = 0; i < A.rows(); ++i)
      if (A(i, k) != 0.0) P.row(i) += A(i, k) * PA.row(k);
}

}  // namespace

void ObserverParams::validate(Index n_y) const {
  requireNonNegative(noise_std, n_y, "controller.observer.noise_std");
  const std::string change = "controller.observer.disturbance_std";
  requireNonNegative(disturbance_std, n_y, change);
  require(!estimated.empty() || (disturbance_std.array() > 0.0).all(), change,
          "numbers > 0 where nothing is estimated");
  const std::string at_inputs = "controller.observer.input_std";
  if (atInputs()) requireNonNegative(input_std, input_std.size(), at_inputs);
  require((input_std.array() > 0.0).count() <= n_y, at_inputs,
          "no more inputs with a disturbance than outputs that show it");
  for (const EstimatedDisturbance& d : estimated) {
    const std::string key = "controller.observer.estimated." + d.name;
    require(std::isfinite(d.std) && d.std > 0.0, key + ".std", "a number > 0");
    require(std::isfinite(d.walk_std) && d.walk_std >= 0.0, key + ".walk_std", "a number >= 0");
  }
}

bool ObserverParams::beginsMoving() const {
  return !estimated.empty() && !atInputs() && !disturbance_std.any() &&
         std::all_of(estimated.begin(), estimated.end(),
                     [](const EstimatedDisturbance& d) { return d.walk_std > 0.0; });
}

DisturbanceObserver::DisturbanceObserver(ObserverParams params, Index n_x,
                                         std::vector<Index> output_rows)
    : params_((params.validate(static_cast<Index>(output_rows.size())), std::move(params))),
      n_x_(n_x),
      n_y_(static_cast<Index>(output_rows.size())),
      n_d_(params_.atInputs() ? params_.input_std.size() : n_y_),
      rows_(std::move(output_rows)),
      F_(Matrix::Identity(n_x_ + n_d_, n_x_ + n_d_)),
      P_(Matrix::Zero(n_x_ + n_d_, n_x_ + n_d_)),
      PF_(P_),
      PC_(Matrix::Zero(n_x_ + n_d_, n_y_)),
      S_(Matrix::Zero(n_y_, n_y_)),
      K_(PC_),
      IKC_(P_),
      R_(Vector::Zero(n_y_)),
      disturbance_(Vector::Zero(n_d_)),
      innovation_(R_),
      correction_(Vector::Zero(n_x_ + n_d_)),
      factor_(Matrix::Identity(n_y_, n_y_)) {
  for (Index i = 0; i < n_y_ && !params_.atInputs(); ++i)
    F_(rows_[static_cast<std::size_t>(i)], n_x_ + i) = 1.0;
  reset();
}

void DisturbanceObserver::reset() {
  P_.setZero();
  disturbance_.setZero();
  innovation_.setZero();
  for (Index i = 0; i < n_y_; ++i) {
    const Index row = rows_[static_cast<std::size_t>(i)];
    const double noise = params_.noise_std[i], change = params_.disturbance_std[i];
    R_[i] = std::max(noise * noise, noise > 0.0 ? kLeastNoise * change * change : 0.0);
    P_(row, row) = noise * noise;
    if (!params_.atInputs())
      P_(n_x_ + i, n_x_ + i) =
          change > 0.0 ? std::pow(kUnknownChanges * std::max(noise, change), 2) : 0.0;
  }
  for (Index j = 0; j < n_d_ && params_.atInputs(); ++j)
    P_(n_x_ + j, n_x_ + j) = std::pow(kUnknownChanges * params_.input_std[j], 2);
}

void DisturbanceObserver::reset(MatrixRef root) {
  reset();
  P_.topLeftCorner(n_x_, n_x_).noalias() = root.lazyProduct(root.transpose());
}

void DisturbanceObserver::startFrom(VectorRef shortfall) {
  for (Index i = 0; i < n_y_; ++i) {
    const double d = shortfall[rows_[static_cast<std::size_t>(i)]];
    disturbance_[i] = std::isfinite(d) ? d : 0.0;
  }
}

void DisturbanceObserver::predict(const Matrix& A) {
  F_.topLeftCorner(n_x_, n_x_) = A;
  multiplyBothSides(F_, P_, PF_);
  for (Index i = 0; i < n_d_; ++i) P_(n_x_ + i, n_x_ + i) += change()[i] * change()[i];
}

void DisturbanceObserver::predict(const Matrix& A, const Matrix& E) {
  F_.topRightCorner(n_x_, n_d_) = E;
  predict(A);
}

bool DisturbanceObserver::computeGain() {
  for (Index i = 0; i < n_y_; ++i) PC_.col(i) = P_.col(rows_[static_cast<std::size_t>(i)]);
  for (Index i = 0; i < n_y_; ++i) S_.row(i) = PC_.row(rows_[static_cast<std::size_t>(i)]);
  S_.diagonal() += R_;
  factor_.compute(S_);
  if (factor_.info() != Eigen::Success || !(factor_.vectorD().array() > 0.0).all()) return false;
  for (Index row = 0; row < K_.rows(); ++row) {
    innovation_ = PC_.row(row);  // S symmetric: K' = S^-1 (P C')'
    factor_.solveInPlace(innovation_);
    K_.row(row) = innovation_;
  }
  return K_.allFinite();
}

bool DisturbanceObserver::correct(VectorRef outputs, Eigen::Ref<Vector> state) {
  if (!computeGain()) {
    innovation_.setZero();
    return false;
  }
  for (Index i = 0; i < n_y_; ++i)
    innovation_[i] = outputs[i] - state[rows_[static_cast<std::size_t>(i)]];
  correction_.noalias() = K_.lazyProduct(innovation_);
  if (!correction_.allFinite()) return false;
  state += correction_.head(n_x_);
  disturbance_ += correction_.tail(n_d_);
  applyGain();
  return true;
}

void DisturbanceObserver::readAfterRest(const Matrix& rest, const Matrix& A) {
  // The gain of an output of which nothing is known: all of what is read is where it rested.
  for (Index i = 0; i < n_y_; ++i) {
    correction_.head(n_x_) = rest.col(i);
    correction_.head(n_x_).noalias() -= A.lazyProduct(rest.col(i));
    K_.col(i).head(n_x_) = rest.col(i);
    for (Index d = 0; d < n_y_; ++d)
      K_(n_x_ + d, i) = correction_[rows_[static_cast<std::size_t>(d)]];
  }
  applyGain();
}

void DisturbanceObserver::applyGain() {
  IKC_.setIdentity();
  for (Index i = 0; i < n_y_; ++i) IKC_.col(rows_[static_cast<std::size_t>(i)]) -= K_.col(i);
  multiplyBothSides(IKC_, P_, PF_);
  for (Index i = 0; i < n_y_; ++i)
    for (Index row = 0; row < P_.rows(); ++row)
      for (Index column = 0; column < P_.cols(); ++column)
        P_(row, column) += K_(row, i) * R_[i] * K_(column, i);
}

void DisturbanceObserver::addDisturbance(Eigen::Ref<Vector> state) const {
  for (Index i = 0; i < n_y_; ++i) state[rows_[static_cast<std::size_t>(i)]] += disturbance_[i];
}

}  // namespace fpc
