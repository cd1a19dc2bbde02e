// Performance indices sample by sample: the same sums as outputIndices() and inputIndices(), bit
// for bit, of a run that is not kept.
#pragma once

#include <cstdint>

#include "analysis/performance.hpp"

namespace fpc {

/// Of one output; see OutputIndices.
class RunningOutput {
 public:
  /// @throws InputError unless sample_time_h is a number > 0.
  explicit RunningOutput(double sample_time_h);
  void add(double y, double setpoint, double reference);
  /// A sample whose y counts for nothing: time goes on. All rejected: the sums are NaN.
  void reject() { ++samples_, ++sums_.rejected; }
  OutputIndices indices() const;

 private:
  double sample_time_h_;
  std::uint64_t samples_{}, referred_{};  // referred: with a reference
  OutputIndices sums_;
};

/// Of one input; see InputIndices.
class RunningInput {
 public:
  explicit RunningInput(double before);  ///< u(-1)
  void add(double applied);
  InputIndices indices() const;

 private:
  double before_, last_;
  std::uint64_t samples_{};
  InputIndices sums_;
};

}  // namespace fpc
