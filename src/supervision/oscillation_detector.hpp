// A law that throws an input from one end of its range to the other and back.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Watches what a law asks of one input, as moves from the applied one in parts of the range. Three
/// changes of direction between moves above `large` within twelve samples are a swing: around a
/// change of the gain's sign, or at a setpoint that the model holds for possible and the plant does
/// not. The third and every further turn halves the moves that are allowed, from an eighth of the
/// range down to a fiftieth; while they are less than all, wishes for more than them count as
/// large. Without a turn they open again by half in `release` samples, and by half in every sample
/// once all wishes of more than a window were large and one way: that is no swing.
class OscillationDetector {
 public:
  /// @param large in parts of the range; 0 never finds a swing.
  OscillationDetector(double large, int release);
  void reset();
  /// One sample: the wish minus the applied input, in parts of the range.
  /// @return the largest move allowed now, in the same parts; 1 while nothing swings.
  double allow(double wish);
  bool swings() const { return allowed_ < 1.0; }

 private:
  static constexpr int kWindow = 12;

  double large_, opening_;
  double allowed_{1.0};
  int one_way_{0};                ///< samples in a row of large wishes in that direction
  int last_{0};                   ///< direction of the newest large wish ...
  int since_{kWindow};            ///< ... and how long ago
  int turned_[kWindow]{}, at_{};  ///< a ring: 1 where the direction changed
};

}  // namespace fpc
