// Does a signal oscillate, with which period, how regularly?
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// The strongest oscillation of a signal. Times in samples.
struct Oscillation {
  bool found{};
  double period{kNaN};      ///< mean of the intervals between zero crossings of the autocorrelation
  double regularity{kNaN};  ///< mean over three standard deviations of these; above 1: regular
  double amplitude{kNaN};   ///< of a sine of this power
  double share{kNaN};       ///< of the signal's variance, in the octave around it
  double after_one{kNaN};   ///< autocorrelation one period later
  double unrest{kNaN};      ///< standard deviation over mean of the envelope: a sine 0, noise 0.52
};

/// Regular crossings of the autocorrelation in a band around the highest peak of the spectrum, f S.
/// At least twelve periods must fit into the record. NaN counts as the mean. Source: thornhill2003
Oscillation findOscillation(const std::vector<double>& signal);

/// Autocorrelation at lags 0..`most`, of what is there in pairs.
std::vector<double> autocorrelationOf(const std::vector<double>& signal, Eigen::Index most);

}  // namespace fpc
