// The past values of one signal inside a state vector.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Shifts the `count` values from row `first` on by one sample; the newest comes first.
inline void pushNewest(Eigen::Ref<Vector> state, Eigen::Index first, int count, double newest) {
  for (Eigen::Index row = first + count - 1; row > first; --row) state[row] = state[row - 1];
  if (count > 0) state[first] = newest;
}

}  // namespace fpc
