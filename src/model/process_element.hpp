// An element of a process, K (beta s + 1) exp(-theta s) / ((tau_1 s + 1) (tau_2 s + 1)), with s in
// the place of the first lag, or with a pair of complex poles, and what it becomes between samples
// whose input is held: exact for dead times that are no whole number of samples.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Times in seconds. `time_constant` < 0: an unstable pole. With `integrating` the gain is per
/// second and `time_constant` is not used.
struct ProcessElement {
  double gain{};
  double time_constant{};  ///< tau_1, not 0
  double second{};         ///< tau_2 >= 0
  double lead{};           ///< beta; negative: inverse response
  double dead_time{};      ///< theta >= 0
  bool integrating{false};
  double damping{1.0};  ///< zeta < 1: tau_1^2 s^2 + 2 zeta tau_1 s + 1, tau_2 = tau_1

  double step(double time_s) const;  ///< response to a unit step at time 0
  double lags() const;               ///< tau_1 + tau_2 without an unstable one, or 2 zeta tau_1 [s]
  double settling() const;           ///< when about 95 % of a step's effect are there [s]
};

/// y(k+1) = -sum_{i>=1} a_i y(k+1-i) + sum_i b_i u(k-delay-i), a_0 = 1. The pole of an integrator
/// or an unstable one, which several elements of an output share, stands apart: a = shared * own.
struct SampledElement {
  std::vector<double> own{1.0}, shared{1.0};  ///< polynomials in 1/z
  std::vector<double> b;
  int delay{};
};
SampledElement sampled(const ProcessElement& element, double sample_time_s);

/// Product of polynomials in 1/z.
std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace fpc
