// What was seen of a loop, as a promise of what is to be seen.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Means of squares over a window, one per signal, and the largest ones that were promised. Larger
/// setpoint changes than those of the promise allow more, by the square of their ratio. No
/// allocation after construction.
class ErrorPromise {
 public:
  static constexpr double kLeaves = 4.0;  ///< times what was promised: twice the amplitude

  ErrorPromise() = default;
  /// @param floor n: mean squares that always pass.
  ErrorPromise(Eigen::Index window, Vector floor);
  /// One sample: squares (n; what is not finite is none) and the largest setpoint change of it. It
  /// counts as a promise, or is only seen.
  void add(VectorRef squares, double change, bool promises);
  /// The signal whose mean square is more than kLeaves times what was promised; -1: none, or
  /// nothing was promised.
  Eigen::Index broken() const;
  double seen(Eigen::Index i) const { return mean_[i]; }
  double promised(Eigen::Index i) const { return promised_[i]; }

 private:
  Matrix squares_;  // n window
  Vector changes_, mean_, promised_, floor_;
  double change_{}, promised_change_{};
  Eigen::Index place_{}, filled_{};
  bool known_{false};
};

}  // namespace fpc
