// Performance indices of a run. Sums over the samples k = 0..N; ISE is the sum of (setpoint - y)^2,
// without Ts.
#pragma once

#include <cstdint>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Of one output: e = setpoint - y (measured). Time weights in hours.
struct OutputIndices {
  double ise{};              ///< sum e^2
  double iae{};              ///< sum |e|
  double itae{};             ///< sum t |e|, t in h
  double itse{};             ///< sum t e^2, t in h
  double rmse{};             ///< sqrt(ise / samples in the sum), N + 1 if none was rejected
  double ise_reference{};    ///< sum (y_r - y)^2, of samples with a reference
  std::uint64_t rejected{};  ///< measurements that are in none of the sums
};

/// Of one input, over the applied values u(0)..u(N-1); moves include u(0) - u(-1).
struct InputIndices {
  double min{}, max{}, mean_abs_move{};
  double travel{};           ///< sum of |moves|
  std::uint64_t switches{};  ///< moves of more than 1e-9
  double effort{};           ///< sum of moves^2
  double energy{};           ///< sum of u^2
};

/// How an output follows one step of its setpoint. z goes from 0 (the setpoint before, of the first
/// step y(0)) to 1 (the new one). Times in the unit of the sample time, linear between samples.
struct StepIndices {
  Eigen::Index first{}, last{};  ///< samples: the step, the next step (or the end)
  double from{}, to{};           ///< setpoints
  double rise{};                 ///< from z = 0.1 to z = 0.9; never: the whole step
  double settling{};             ///< z stays within the band from here on; never: the whole step
  double overshoot{};            ///< max z - 1, at least 0 [%]
  double offset{};               ///< mean |z - 1| over the last tenth of the step [%]
  /// 10 Es + Ov + Ts + Tr: taieb2017, eq. 15.
  double cost() const { return 10.0 * offset + overshoot + settling + rise; }
};

/// y, setpoint, reference: k = 0..N. A sample that is not finite makes the sums NaN: nothing is
/// left out in silence. No samples give zeros.
/// @throws InputError if the sizes differ or sample_time_h is not a number > 0.
OutputIndices outputIndices(VectorRef y, VectorRef setpoint, VectorRef reference,
                            double sample_time_h);
/// One entry for each step of the setpoint, the one from y(0) included. Changes in samples that
/// follow each other are one step (a ramp); changes below 1 % of the largest are no steps. A sample
/// of y that is not finite makes the indices of its step NaN.
/// @throws InputError if the sizes differ, or unless sample_time and band are numbers > 0.
std::vector<StepIndices> stepIndices(VectorRef y, VectorRef setpoint, double sample_time,
                                     double band = 0.02);
/// applied: u(0)..u(N-1); before: u(-1). Without samples the input stays at `before`.
InputIndices inputIndices(VectorRef applied, double before);

}  // namespace fpc
