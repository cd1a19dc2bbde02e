#include "estimation/output_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/require_numbers.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kStateStep = 1e-5;  // of a state, for the Jacobian

}  // namespace

void EstimatorParams::validate(Index n_y) const {
  for (const Index i : outputs)
    require(i >= 0 && i < n_y, "estimator.outputs", "outputs of the plant");
  require(static_cast<Index>(outputs.size()) < n_y, "estimator.outputs",
          "at least one output that is measured");
  require(initial.size() == n_y && initial.allFinite(), "estimator.initial", "finite numbers");
  requireNonNegative(initial_std, n_y, "estimator.initial_std");
  requireNonNegative(noise_std, n_y, "estimator.noise_std");
  requirePositive(process_std, n_y, "estimator.process_std");
}

OutputEstimator::OutputEstimator(const TsModel& model, EstimatorParams params)
    : local_(model),
      params_(std::move(params)),
      measured_(model.outputs.size(), true),
      state_(Vector::Zero(local_.stateSize())),
      next_(state_),
      moved_(state_),
      gain_(state_),
      known_(Vector::Zero(static_cast<Index>(model.outputs.size()))),
      F_(Matrix::Zero(state_.size(), state_.size())),
      P_(F_),
      FP_(F_) {
  params_.validate(known_.size());
  for (const Index i : params_.outputs) measured_[static_cast<std::size_t>(i)] = false;
}

double OutputEstimator::estimate(Index output) const { return state_[local_.outputState(output)]; }

double OutputEstimator::deviation(Index output) const {
  const Index row = local_.outputState(output);
  return std::sqrt(std::max(0.0, P_(row, row)));
}

/// Covariances of a start: every lag of an output is as uncertain as the output.
void OutputEstimator::start(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  for (Index i = 0; i < known_.size(); ++i)
    if (isMeasured(i)) known_[i] = outputs[i];
  local_.restState(known_, input, disturbances, state_);
  P_.setZero();
  for (Index i = 0; i < known_.size(); ++i) {
    const double std = isMeasured(i) ? params_.noise_std[i] : params_.initial_std[i];
    for (int lag = 0; lag <= local_.model().maxLag(SignalKind::kOutput, static_cast<int>(i));
         ++lag) {
      const Index row = local_.outputState(i, lag);
      P_(row, row) = std * std;
    }
  }
}

void OutputEstimator::rest(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  known_ = params_.initial;
  start(outputs, input, disturbances);
}

void OutputEstimator::resume(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  for (Index i = 0; i < known_.size(); ++i) known_[i] = estimate(i);
  if (!known_.allFinite()) known_ = params_.initial;
  start(outputs, input, disturbances);
}

void OutputEstimator::move(VectorRef input, VectorRef disturbances, Vector& state) {
  local_.advance(state, input, disturbances, next_);
  state.swap(next_);
}

void OutputEstimator::predict(VectorRef input, VectorRef disturbances) {
  for (Index j = 0; j < state_.size(); ++j) {
    const double h = kStateStep * std::max(1.0, std::abs(state_[j]));
    moved_ = state_;
    moved_[j] += h;
    move(input, disturbances, moved_);
    F_.col(j) = moved_;
    gain_[j] = h;
  }
  move(input, disturbances, state_);
  for (Index j = 0; j < state_.size(); ++j) F_.col(j) = (F_.col(j) - state_) / gain_[j];
  FP_.noalias() = F_.lazyProduct(P_);
  P_.noalias() = FP_.lazyProduct(F_.transpose());
  for (Index i = 0; i < known_.size(); ++i) {
    const Index row = local_.outputState(i);
    P_(row, row) += params_.process_std[i] * params_.process_std[i];
  }
}

/// One measured output: K = P c / (c' P c + R).
void OutputEstimator::correct(Index output, double measured) {
  const Index row = local_.outputState(output);
  const double noise = params_.noise_std[output];
  const double s = P_(row, row) + noise * noise;
  if (!(s > 0.0) || !std::isfinite(measured)) return;
  gain_ = P_.col(row) / s;
  state_ += (measured - state_[row]) * gain_;
  for (Index j = 0; j < P_.cols(); ++j) P_.col(j) -= P_(row, j) * gain_;
  FP_ = P_.transpose();
  P_ = 0.5 * (P_ + FP_);
}

void OutputEstimator::advance(VectorRef outputs, VectorRef input, VectorRef disturbances) {
  predict(input, disturbances);
  for (Index i = 0; i < outputs.size(); ++i)
    if (isMeasured(i)) correct(i, outputs[i]);
}

}  // namespace fpc
