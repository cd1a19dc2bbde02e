// Section `estimator` of a loop file.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// What an observer of outputs that nobody measures is told.
struct EstimatorParams {
  std::vector<Eigen::Index> outputs;  ///< that are not measured, in the plant's order; empty: none
  Vector initial;                     ///< n_y, where those are taken to be at the start
  Vector initial_std;                 ///< n_y, how badly that is known
  Vector noise_std;                   ///< n_y, of the measurements of the others; 0: exact
  Vector process_std;                 ///< n_y, what the model errs by per sample, > 0
  /// @throws InputError naming estimator.KEY.
  void validate(Eigen::Index n_y) const;
};

}  // namespace fpc
