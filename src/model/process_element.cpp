#include "model/process_element.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

constexpr double kSameLag = 1e-6;  // of a lag: two lags that are one
constexpr double kSmallAngle = 1e-6;
constexpr double kWhole = 1e-9;     // of a sample: a dead time that is whole
constexpr double kShortLag = 1e-3;  // of a sample: a lag that is none

}  // namespace

std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
  return c;
}

double ProcessElement::step(double time_s) const {
  const double t = time_s - dead_time;
  if (t <= 0.0) return 0.0;
  if (integrating) {
    const double lag = second > 0.0 ? (lead - second) * -std::expm1(-t / second) : lead;
    return gain * (t + lag);
  }
  const double one = time_constant, e_1 = std::exp(-damping * t / one);
  if (damping < 1.0) {
    const double swing = std::sqrt(1.0 - damping * damping) * t / one;
    const double sine = swing > kSmallAngle ? std::sin(swing) / swing : 1.0;
    return gain * (1.0 - e_1 * (std::cos(swing) + (damping - lead / one) * sine * t / one));
  }
  if (second <= 0.0) return gain * (1.0 - (1.0 - lead / one) * e_1);
  if (std::abs(one - second) < kSameLag * std::abs(one))
    return gain * (1.0 - (1.0 + (1.0 - lead / one) * t / one) * e_1);
  const double e_2 = std::exp(-t / second), d = one - second;
  return gain * (1.0 + (lead - one) / d * e_1 + (second - lead) / d * e_2);
}

double ProcessElement::lags() const {
  if (damping < 1.0) return 2.0 * damping * time_constant;
  return (integrating ? 0.0 : std::max(time_constant, 0.0)) + second;
}

double ProcessElement::settling() const {
  if (damping < 1.0)
    return dead_time + (3.0 / damping + 1.0) * time_constant + std::abs(std::min(lead, 0.0));
  const double first = integrating ? 0.0 : std::abs(time_constant);
  const double slow = std::max(first, second), fast = std::min(first, second);
  return dead_time + 3.0 * slow + fast + std::abs(std::min(lead, 0.0));
}

SampledElement sampled(const ProcessElement& e, double Ts) {
  SampledElement s;
  if (e.integrating) {
    s.shared = {1.0, -1.0};
  } else if (e.time_constant < 0.0) {
    s.shared = {1.0, -std::exp(-Ts / e.time_constant)};
  } else if (e.damping < 1.0) {
    const double left = std::exp(-e.damping * Ts / e.time_constant);
    const double swing = std::sqrt(1.0 - e.damping * e.damping) * Ts / e.time_constant;
    s.own = {1.0, -2.0 * left * std::cos(swing), left * left};
  } else {
    s.own = {1.0, -std::exp(-Ts / e.time_constant)};
  }
  if (e.damping >= 1.0 && e.second > kShortLag * Ts)
    s.own = product(s.own, {1.0, -std::exp(-Ts / e.second)});
  const double samples = e.dead_time / Ts;
  s.delay = static_cast<int>(std::floor(samples + kWhole));
  const std::vector<double> a = product(product(s.own, s.shared), {1.0, -1.0});
  const bool fractional = samples - s.delay > kWhole;
  const std::size_t terms = a.size() - 2 + (fractional ? 1 : 0);
  ProcessElement whole = e;  // without the whole samples of dead time
  whole.dead_time = fractional ? e.dead_time - s.delay * Ts : 0.0;
  // B = A (1 - 1/z) S with S the samples of the step response.
  std::vector<double> response(terms + 1, 0.0);
  for (std::size_t k = 1; k <= terms; ++k) response[k] = whole.step(static_cast<double>(k) * Ts);
  s.b.assign(terms, 0.0);
  for (std::size_t k = 1; k <= terms; ++k)
    for (std::size_t i = 0; i < a.size() && i < k; ++i) s.b[k - 1] += a[i] * response[k - i];
  return s;
}

}  // namespace fpc
