// Limits of the inputs, the same for controllers, optimizer and actuator: bounds hold at every
// step, whatever happens.
#pragma once

#include <string>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// Limits of the inputs, shared by actuator, controllers and optimizer (the section `actuator` of a
/// loop file).
struct InputLimits {
  Vector lower, upper;  ///< n_u, absolute
  Vector move;          ///< n_u, largest |u(k) - u(k-1)|, infinite if absent
  /// @throws InputError naming the field: sizes, lower <= upper, move > 0, no NaN.
  void validate(Eigen::Index n_u) const;
  /// Clips to the move limit, then to the bounds: where they conflict the bound wins.
  /// A NaN element becomes the previous input. Returns true if the move limit had to give way.
  bool clip(Eigen::Ref<Vector> input, VectorRef previous) const;
};

}  // namespace fpc
