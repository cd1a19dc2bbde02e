// Section `standstill` of a loop file.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// A measured signal that must not stand still.
struct WatchedSignal {
  std::string name;
  bool is_output{true};
  Eigen::Index place{};   ///< among outputs or measured disturbances
  double least_change{};  ///< largest minus smallest value over the window is usually more
  double noise_std{0.0};  ///< of what is measured: a sensor that shows this and no more stands
};

/// Which signals must not stand still, and what a law does while one does.
struct StandstillParams {
  std::vector<WatchedSignal> signals;  ///< empty: nothing is watched
  int window_samples{24};
  int noise_window_samples{96};  ///< of signals with noise, in eight blocks
  Vector usual;                  ///< n_d, the law's value of a disturbance that stands still
  Vector fallback;  ///< n_u, the input while an output stands still and no controller acts
  /// @throws InputError naming standstill.KEY.
  void validate(Eigen::Index n_y, Eigen::Index n_u, Eigen::Index n_d) const;
};

}  // namespace fpc
