// Sample times from integers, so that no rounding adds up: t_k = t0 + k Ts.
#pragma once

#include <cstdint>

#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// Turns steps into times [ns] and back.
class SampleClock {
 public:
  /// @throws InputError unless both are > 0 and at most 9e9 s (start 0 is special to rosbag and
  /// tf2).
  SampleClock(double sample_time_s, double start_time_s);

  std::int64_t timeAt(std::uint32_t step) const { return start_ns_ + step * sample_ns_; }
  /// First step whose time is not before `time_ns` (0 before the start, 2^32 - 1 at most).
  std::uint32_t firstStepAt(std::int64_t time_ns) const;
  /// The same for a time [h] that a person wrote after the start: counted in samples, so that k Ts,
  /// rounded to a decimal, is sample k. A time within a microsecond of a sample is meant to be it.
  std::uint32_t firstStepAtHours(double time_h) const;
  double hoursAt(std::uint32_t step) const;  ///< time since sample 0 [h]
  double sampleTime() const { return sample_time_s_; }
  std::int64_t startNanoseconds() const { return start_ns_; }
  StepHeader header(std::uint64_t run_id, std::uint32_t step) const {
    return {timeAt(step), run_id, step};
  }

 private:
  double sample_time_s_;
  std::int64_t sample_ns_;
  std::int64_t start_ns_;
};

}  // namespace fpc
