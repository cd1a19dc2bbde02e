// A law that throws an input from one end of its range to the other and back.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Watches what a law asks of one input, as moves from the applied one in parts of the range. Three
/// changes of direction between moves above `large` within twelve samples are a swing: around a
/// change of the gain's sign, or at a setpoint that the model holds for possible and the plant does
/// not.
class OscillationDetector {
 public:
  /// @param large in parts of the range, > 0.
  explicit OscillationDetector(double large) : large_(large) {}
  void reset() { *this = OscillationDetector(large_); }
  /// One sample: the wish minus the applied input, in parts of the range; what is not finite is
  /// passed over. @return whether there has been a swing since reset().
  bool add(double wish);

 private:
  static constexpr int kWindow = 12;

  double large_;
  int last_{0};                   ///< direction of the newest large wish ...
  int since_{kWindow};            ///< ... and how long ago
  int turned_[kWindow]{}, at_{};  ///< a ring: 1 where the direction changed
  bool found_{false};
};

}  // namespace fpc
