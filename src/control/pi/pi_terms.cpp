#include "control/pi/pi_terms.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void requireNotNegative(double value, const std::string& key) {
  require(std::isfinite(value) && value >= 0.0, key, "a number >= 0");
}

}  // namespace

double valueOf(const std::vector<CurvePoint>& curve, double at, double empty) {
  if (curve.empty()) return empty;
  const auto after =
      std::find_if(curve.begin(), curve.end(), [&](const auto& p) { return p.at > at; });
  if (after == curve.begin()) return curve.front().value;
  if (after == curve.end()) return curve.back().value;
  const CurvePoint& before = *(after - 1);
  return before.value + (at - before.at) / (after->at - before.at) * (after->value - before.value);
}

void validateCurve(const std::vector<CurvePoint>& curve, const std::string& key) {
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const bool increasing = i == 0 || curve[i].at > curve[i - 1].at;
    require(increasing && std::isfinite(curve[i].at) && std::isfinite(curve[i].value), key,
            "[x, value] of finite numbers, x increasing");
  }
}

double PiFeedforward::valueOf(const Vector& disturbances) const {
  return disturbances[disturbance] * (times < 0 ? 1.0 : disturbances[times]);
}

bool PiTerms::any() const {
  return kd_h != 0.0 || preview_h > 0.0 || setpoint_pole > 0.0 || setpoint_lead_h != 0.0 ||
         !static_input.empty() || !feedforward.empty();
}

void PiTerms::validate(const std::string& key, Eigen::Index n_d) const {
  require(std::isfinite(kd_h), key + "kd_h", "a finite number");
  requireNotNegative(derivative_lag_h, key + "derivative_lag_h");
  requireNotNegative(preview_h, key + "preview_h");
  requireNotNegative(setpoint_lead_h, key + "setpoint_lead_h");
  require(setpoint_pole >= 0.0 && setpoint_pole < 1.0, key + "setpoint_pole",
          "a number >= 0 and < 1");
  validateCurve(static_input, key + "static_input");
  for (std::size_t i = 0; i < feedforward.size(); ++i) {
    const PiFeedforward& f = feedforward[i];
    const std::string where = key + "feedforward[" + std::to_string(i) + "].";
    require(f.disturbance >= 0 && f.disturbance < n_d, where + "disturbance",
            "a measured disturbance");
    require(f.times >= -1 && f.times < n_d, where + "times", "a measured disturbance");
    require(std::isfinite(f.gain), where + "gain", "a finite number");
    require(std::isfinite(f.nominal), where + "nominal", "a finite number");
    requireNotNegative(f.lag_h, where + "lag_h");
  }
}

PiTermState::PiTermState(const PiTerms& terms, int output, Eigen::Index n_y, double sample_time_s)
    : terms_(terms),
      output_(output),
      sample_time_h_(sample_time_s / 3600.0),
      preview_samples_(static_cast<std::uint32_t>(
          std::llround(std::min(terms.preview_h / sample_time_h_, 1e6)))),
      ahead_(Vector::Zero(n_y)),
      lagged_(Vector::Zero(static_cast<Eigen::Index>(terms.feedforward.size()))) {}

void PiTermState::reset() { fresh_ = true; }

double PiTermState::aim(const Measurement& now, const SetpointSource& setpoint) {
  double target = setpoint.present()[output_];
  if (preview_samples_ > 0) {
    setpoint.scheduled(now.header.step + preview_samples_, ahead_);
    target = ahead_[output_];
  }
  if (terms_.setpoint_pole > 0.0) {
    // y_r(k+1) = a y_r(k) + (1 - a) setpoint(k), y_r(0) = y(0), as ReferenceTrajectory
    const double before = fresh_ ? now.outputs[output_] : path_;
    path_before_ = before;
    path_ = terms_.setpoint_pole * before + (1.0 - terms_.setpoint_pole) * target;
    return before + terms_.setpoint_lead_h * (path_ - before) / sample_time_h_;
  }
  path_before_ = fresh_ ? target : path_;
  path_ = target;
  return target + terms_.setpoint_lead_h * (path_ - path_before_) / sample_time_h_;
}

double PiTermState::derivative(double output) {
  const double rate = fresh_ ? 0.0 : (output - output_before_) / sample_time_h_;
  const double share = sample_time_h_ / (terms_.derivative_lag_h + sample_time_h_);
  slope_ = fresh_ ? 0.0 : slope_ + share * (rate - slope_);
  output_before_ = output;
  return -terms_.kd_h * slope_;
}

double PiTermState::feedforward(const Measurement& now) {
  double sum = 0.0;
  for (std::size_t i = 0; i < terms_.feedforward.size(); ++i) {
    const PiFeedforward& f = terms_.feedforward[i];
    const double d = f.valueOf(now.disturbances) - f.nominal;
    double& slow = lagged_[static_cast<Eigen::Index>(i)];
    if (fresh_) slow = d;
    slow += (f.lag_h > 0.0 ? -std::expm1(-sample_time_h_ / f.lag_h) : 1.0) * (d - slow);
    sum += f.gain * slow;
  }
  return sum;
}

double PiTermState::sum(const Measurement& now, double gain) {
  const double from = terms_.setpoint_pole > 0.0 ? path_before_ : path_;
  const double at = from + terms_.setpoint_lead_h * (path_ - path_before_) / sample_time_h_;
  const double total = valueOf(terms_.static_input, at, 0.0) +
                       gain * derivative(now.outputs[output_]) + feedforward(now);
  fresh_ = false;
  return total;
}

}  // namespace fpc
