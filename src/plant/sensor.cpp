#include "plant/sensor.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kEarlySample = 1e-6;  // [s], rounding of times that are sums of steps
constexpr std::uint64_t kLossStream = 1;

bool isTime(double value) { return std::isfinite(value) && value >= 0.0; }

}  // namespace

void SensorParams::validate() const {
  require(lags >= 0 && lags <= 20, "lags", "a number >= 0 and <= 20");
  require(isTime(lag_s) && (lags == 0) == (lag_s == 0.0), "lag_s", "a time > 0 with lags");
  require(isTime(delay_s), "delay_s", "a time >= 0");
  require(isTime(interval_s), "interval_s", "a time >= 0");
  require(std::isfinite(noise_std) && noise_std >= 0.0, "noise_std", "a finite number >= 0");
  require(std::isfinite(resolution) && resolution >= 0.0, "resolution", "a finite number >= 0");
  require(lost >= 0.0 && lost <= 1.0, "lost", "a number from 0 to 1");
  require(lower < upper, "range", "[lower, upper] with lower < upper");
  require(stuck_from_h >= 0.0 && stuck_from_h <= stuck_to_h, "stuck_to_h",
          "a time >= stuck_from_h");
}

SensorParams sensorOfClass(SensorClass kind, double lower, double upper) {
  SensorParams p;
  p.lower = lower;
  p.upper = upper;
  if (kind == SensorClass::kD) {  // a batch: the result is there when the next one begins
    p.delay_s = p.interval_s = 1800.0;
    return p;
  }
  const bool slow = kind == SensorClass::kC0 || kind == SensorClass::kC1;
  p.lags = kind == SensorClass::kA ? 2 : 8;
  p.lag_s = (kind == SensorClass::kA ? 60.0 : slow ? 1200.0 : 600.0) / lagsToNinety(p.lags);
  if (kind == SensorClass::kB1 || kind == SensorClass::kC1) p.interval_s = 300.0;
  return p;
}

Sensor::Sensor(const SensorParams& params, double step_s, std::uint64_t seed, std::uint64_t stream)
    : params_(params), seed_(seed), stream_(stream), step_s_(step_s) {
  params_.validate();
  if (params_.lags > 0) chain_.emplace(params_.lags, params_.lag_s);
  const double samples = params_.delay_s / step_s_;
  require(samples <= 1e6, "delay_s", "at most 1e6 steps");
  line_.assign(static_cast<std::size_t>(std::ceil(samples - 1e-9)) + 2, 0.0);
  reset(0.0);
}

void Sensor::reset(double value) {
  engine_ = seededEngine(seed_, {stream_});
  lost_ = seededEngine(seed_, {stream_, kLossStream});
  if (chain_) chain_->reset(value);
  std::fill(line_.begin(), line_.end(), value);
  next_ = 0;
  time_s_ = sum_ = 0.0;
  count_ = 0;
  due_s_ = 0.0;
  shown_ = value;
  show();
}

/// The value `delay_s` ago, between the stored steps in a straight line.
double Sensor::delayed(double value, double seconds) {
  line_[next_] = value;
  const double back = params_.delay_s / seconds;
  const auto whole = static_cast<std::size_t>(back);
  const std::size_t n = line_.size();
  const auto past = [&](std::size_t steps) {
    return line_[(next_ + n - std::min(steps, n - 1)) % n];
  };
  const double part = back - static_cast<double>(whole);
  const double result = past(whole) + part * (past(whole + 1) - past(whole));
  next_ = (next_ + 1) % n;
  return result;
}

void Sensor::advance(double from, double to, double seconds) {
  if (chain_) chain_->advance(from, to, seconds);
  time_s_ += seconds;
  const double value = delayed(chain_ ? chain_->output() : to, seconds);
  const bool stuck = time_s_ >= 3600.0 * params_.stuck_from_h - kEarlySample &&
                     time_s_ < 3600.0 * params_.stuck_to_h - kEarlySample;
  if (!stuck) shown_ = value;
  if (!stuck) show();
  sum_ += reading_;
  ++count_;
}

/// A new reading, if one is due.
void Sensor::show() {
  if (time_s_ < due_s_ - kEarlySample) return;
  if (params_.interval_s > 0.0)
    due_s_ = (std::floor((time_s_ + kEarlySample) / params_.interval_s) + 1.0) * params_.interval_s;
  const double noise = params_.noise_std > 0.0 ? params_.noise_std * standardNormal(engine_) : 0.0;
  double value = shown_ + noise;
  if (params_.resolution > 0.0) value = params_.resolution * std::round(value / params_.resolution);
  reading_ = std::clamp(value, params_.lower, params_.upper);
}

bool Sensor::loses() { return params_.lost > 0.0 && uniform(lost_) < params_.lost; }

double Sensor::take() {
  const double value =
      params_.average && count_ > 0 ? sum_ / static_cast<double>(count_) : reading_;
  sum_ = 0.0;
  count_ = 0;
  return value;
}

}  // namespace fpc
