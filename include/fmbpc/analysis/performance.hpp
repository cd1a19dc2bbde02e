// Performance indices of a run. Sums over the samples k = 0..N; ISE is the sum of (setpoint - y)^2, without Ts.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Of one output: e = setpoint - y (measured). Time weights in hours.
struct OutputIndices {
  double ise{};            ///< sum e^2
  double iae{};            ///< sum |e|
  double itae{};           ///< sum t |e|, t in h
  double itse{};           ///< sum t e^2, t in h
  double rmse{};           ///< sqrt(ise / (N + 1))
  double ise_reference{};  ///< sum (y_r - y)^2
};

/// Of one input, over the applied values u(0)..u(N-1); moves include u(0) - u(-1).
struct InputIndices {
  double min{}, max{}, mean_abs_move{};
};

OutputIndices outputIndices(VectorRef y, VectorRef setpoint, VectorRef reference, double sample_time_h);
InputIndices inputIndices(VectorRef applied, double before);

}  // namespace fpc
