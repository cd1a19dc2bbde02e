#include "control/pi/gain_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kSlowest = 0.99;  // the mean that tells excitation never looks back further

}  // namespace

void GainEstimatorParams::validate() const {
  RlsParams{forgetting, initial_covariance, covariance_bound}.validate();
  require(std::isfinite(excitation_lower) && excitation_lower >= 0.0, "excitation_lower",
          "a finite number >= 0");
}

GainEstimator::GainEstimator(const std::array<Fopdt, 2>& row, double sample_time_min,
                             const GainEstimatorParams& params)
    : row_(row),
      params_(params),
      responses_{LagResponse(row[0], sample_time_min), LagResponse(row[1], sample_time_min)},
      theta_0_(Vector::Ones(params.bias ? 3 : 2)),
      regressor_(theta_0_),
      rls_((params.validate(), theta_0_),
           {params.forgetting, params.initial_covariance, params.covariance_bound}) {
  restart(row[0].gain, row[1].gain);
}

void GainEstimator::restart(double gain_1, double gain_2) {
  theta_0_.setZero();
  theta_0_[0] = gain_1 / row_[0].gain;
  theta_0_[1] = gain_2 / row_[1].gain;
  rls_.reset(theta_0_);
  error_variance_ = weight_ = 0.0;
}

void GainEstimator::rest(double input_1, double input_2) {
  responses_[0].rest(input_1);
  responses_[1].rest(input_2);
  for (std::size_t j = 0; j < 2; ++j) mean_[j] = row_[j].gain * responses_[j].value();
  excitation_ = 0.0;
}

void GainEstimator::advance(double input_1, double input_2) {
  responses_[0].advance(input_1);
  responses_[1].advance(input_2);
  const double keep = std::min(params_.forgetting, kSlowest);
  excitation_ = 0.0;
  for (std::size_t j = 0; j < 2; ++j) {
    const double share = row_[j].gain * responses_[j].value();
    mean_[j] = keep * mean_[j] + (1.0 - keep) * share;
    excitation_ = std::max(excitation_, std::abs(share - mean_[j]));
  }
}

bool GainEstimator::update(double y) {
  if (!(excitation_ >= params_.excitation_lower)) return false;
  for (std::size_t j = 0; j < 2; ++j) regressor_[index(j)] = row_[j].gain * responses_[j].value();
  if (params_.bias) regressor_[2] = 1.0;
  const double error = y - regressor_.dot(rls_.theta());
  if (!rls_.update(regressor_, y)) return false;
  const double left = y - regressor_.dot(rls_.theta());  // error * left: free of what P(0) added
  weight_ = params_.forgetting * weight_ + 1.0;
  error_variance_ += (error * left - error_variance_) / weight_;
  return true;
}

double GainEstimator::deviation(std::size_t j) const {
  return std::sqrt(rls_.variance(index(j)) * std::max(error_variance_, 0.0));
}

}  // namespace fpc
