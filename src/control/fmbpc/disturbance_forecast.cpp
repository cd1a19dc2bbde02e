#include "control/fmbpc/disturbance_forecast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// At which forecasts are judged.
Eigen::Index leadOf(int horizon_steps) { return std::max(1, horizon_steps / 2); }

}  // namespace

DisturbanceForecast::DisturbanceForecast(Eigen::Index n_d, int horizon_steps, int period_steps,
                                         double pole, int memory_steps)
    : past_(Matrix::Zero(n_d, Eigen::Index{std::max(period_steps, 0)} + 1 +
                                  (memory_steps > 0 ? leadOf(horizon_steps) : Eigen::Index{0}))),
      future_(Matrix::Zero(n_d, std::max(horizon_steps, 1))),
      expected_(future_),
      weight_(Vector::Ones(n_d)),
      error_(Vector::Zero(n_d)),
      held_error_(error_),
      fading_(memory_steps > 0 ? std::exp(-1.0 / memory_steps) : 1.0),
      lead_(leadOf(horizon_steps)),
      period_(period_steps),
      pole_(pole) {
  require(period_steps == 0 || period_steps >= horizon_steps, "controller.forecast_period_h",
          "0, or a time not shorter than controller.horizon_steps");
  require(pole >= 0.0 && pole <= 1.0, "pole", "a number from 0 to 1");
}

void DisturbanceForecast::forget() {
  known_ = 0;
  weight_.setOnes();
  error_.setZero();
  held_error_.setZero();
}

/// The forecast of d(k) that was made at k - lead, against holding d(k - lead).
void DisturbanceForecast::learn() {
  const auto back = [&](Eigen::Index samples) {
    return past_.col(column(last_step_ - static_cast<std::uint32_t>(samples)));
  };
  const double faded = std::pow(pole_, static_cast<double>(lead_));
  for (Eigen::Index i = 0; i < weight_.size(); ++i) {
    const double held = back(lead_)[i];
    const double daily = back(period_)[i] + faded * (held - back(lead_ + period_)[i]);
    const double missed = back(0)[i] - daily, missed_held = back(0)[i] - held;
    error_[i] = fading_ * error_[i] + missed * missed;
    held_error_[i] = fading_ * held_error_[i] + missed_held * missed_held;
    const double beyond = error_[i] - held_error_[i], most = (kUseless - 1.0) * held_error_[i];
    weight_[i] = beyond <= 0.0 ? 1.0 : beyond >= most ? 0.0 : 1.0 - beyond / most;
  }
}

Eigen::Index DisturbanceForecast::column(std::uint32_t step) const {
  return static_cast<Eigen::Index>(step) % past_.cols();
}

void DisturbanceForecast::expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) {
  const Eigen::Index n = ahead.size();
  if (n == 0) return;
  if (!expects_ || expected_step_ != k)
    expected_.setConstant(std::numeric_limits<double>::quiet_NaN());
  expects_ = true;
  expected_step_ = k;
  for (Eigen::Index i = 0; i < expected_.cols(); ++i)
    expected_(disturbance, i) = ahead[std::min(i, n - 1)];
}

void DisturbanceForecast::add(std::uint32_t step, VectorRef disturbances) {
  if (known_ > 0 && step < last_step_) forget();
  const Eigen::Index passed = known_ == 0 ? 1 : static_cast<Eigen::Index>(step - last_step_);
  const Eigen::Index fresh = std::min(passed, past_.cols());
  for (Eigen::Index i = 0; i < fresh; ++i)
    past_.col(column(step - static_cast<std::uint32_t>(i))) = disturbances;
  known_ = std::min(known_ + passed, past_.cols());
  last_step_ = step;
  if (fading_ < 1.0 && period_ > 0 && passed == 1 && known_ == past_.cols()) learn();
}

const Matrix& DisturbanceForecast::predict() {
  const auto now = past_.col(column(last_step_));
  const bool daily = period_ > 0 && known_ > period_;
  const auto before = past_.col(daily ? column(last_step_ - static_cast<std::uint32_t>(period_))
                                      : column(last_step_));
  double fading = 1.0;
  for (Eigen::Index i = 0; i < future_.cols(); ++i, fading *= pole_) {
    future_.col(i) = now;
    if (!daily || i == 0) continue;
    const auto back = static_cast<std::uint32_t>(period_ - i);
    future_.col(i) = past_.col(column(last_step_ - back)) + fading * (now - before);
    if (fading_ < 1.0) future_.col(i) = now + weight_.cwiseProduct(future_.col(i) - now);
  }
  if (expects_ && expected_step_ == last_step_)
    future_ = expected_.array().isNaN().select(future_, expected_);
  return future_;
}

}  // namespace fpc
