// How much of a loop's variance no controller could take away: the minimum-variance index.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Of a control error; all NaN where too few samples are there.
struct MinimumVariance {
  double index{kNaN};      ///< least variance over variance, 1: nothing is to be gained
  double std_least{kNaN};  ///< of minimum-variance control, in units of the error
  double std_error{kNaN};  ///< of the error, about its mean
  Eigen::Index samples{};  ///< that were compared
};

/// Regression of the error on its own values `dead_time` and more samples ago: what that leaves is
/// what minimum-variance control would leave. Runs of numbers are used each by itself, NaN parts
/// them. `dead_time` >= 1 sample, the hold included. Source: harris1989, desborough1992
/// @throws InputError for a dead time below one sample.
MinimumVariance minimumVariance(const std::vector<double>& error, int dead_time);

}  // namespace fpc
