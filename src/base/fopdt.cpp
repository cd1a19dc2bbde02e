#include "base/fopdt.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kMostSamples = 1e6;
constexpr double kSnap = 1e-9;

}  // namespace

void Fopdt::validate(const std::string& key) const {
  require(std::isfinite(gain) && gain != 0.0, key + "gain", "a finite number, not 0");
  require(std::isfinite(time_constant) && time_constant > 0.0, key + "time_constant_min",
          "a time > 0");
  require(std::isfinite(dead_time) && dead_time >= 0.0, key + "dead_time_min", "a time >= 0");
}

SampledFopdt sampled(const Fopdt& element, double sample_time_min) {
  double samples = element.dead_time / sample_time_min;
  require(samples <= kMostSamples, "dead_time_min", "at most 1e6 samples");
  if (std::abs(samples - std::round(samples)) < kSnap) samples = std::round(samples);
  const double whole = std::floor(samples), rate = sample_time_min / element.time_constant;
  SampledFopdt lag;
  lag.delay = static_cast<int>(whole);
  lag.a = std::exp(-rate);
  const double late = std::exp(-rate * (1.0 - (samples - whole)));  // a^(1-w)
  lag.near = 1.0 - late;
  lag.far = late - lag.a;
  return lag;
}

LagResponse::LagResponse(const Fopdt& element, double sample_time_min)
    : lag_(sampled(element, sample_time_min)),
      past_(static_cast<std::size_t>(lag_.delay) + 2, 0.0) {}

void LagResponse::rest(double input) {
  std::fill(past_.begin(), past_.end(), input);
  next_ = 0;
  value_ = input;
}

double LagResponse::advance(double input) {
  past_[next_] = input;
  next_ = (next_ + 1) % past_.size();
  const double far = past_[next_], near = past_[(next_ + 1) % past_.size()];
  value_ = lag_.a * value_ + lag_.near * near + lag_.far * far;
  return value_;
}

}  // namespace fpc
