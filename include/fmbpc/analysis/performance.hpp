// Performance indices of a run. Sums over the samples k = 0..N; ISE is the sum of (setpoint - y)^2,
// without Ts.
#pragma once

#include <cstdint>

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
  double travel{};           ///< sum of |moves|
  std::uint64_t switches{};  ///< moves of more than 1e-9
};

/// y, setpoint, reference: k = 0..N. A sample that is not finite makes the sums NaN: nothing is
/// left out in silence. No samples give zeros.
/// @throws InputError if the sizes differ or sample_time_h is not a number > 0.
OutputIndices outputIndices(VectorRef y, VectorRef setpoint, VectorRef reference,
                            double sample_time_h);
/// applied: u(0)..u(N-1); before: u(-1). Without samples the input stays at `before`.
InputIndices inputIndices(VectorRef applied, double before);

}  // namespace fpc
