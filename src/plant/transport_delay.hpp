// What an analyser shows at the end of a sample line: the past, linearly interpolated between
// samples.
#pragma once

#include <cstddef>
#include <vector>

namespace fpc {

/// A delay of any number >= 0 of samples. Before its start the line is filled with the initial
/// value.
class TransportDelay {
 public:
  /// @throws InputError naming `delay_s` unless 0 <= delay_samples <= 1e6.
  explicit TransportDelay(double delay_samples = 0.0);
  void reset(double initial);
  /// Takes the value at this sample, returns the delayed one.
  double pass(double value);

 private:
  double fraction_{};  ///< of the older of the two neighbours
  std::vector<double> past_;
  std::size_t next_{};  ///< where the oldest value is, and the next one goes
};

}  // namespace fpc
