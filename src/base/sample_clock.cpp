#include "fmbpc/base/sample_clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {
constexpr double kLongestS = 9e9;  // what fits into 63 bits of nanoseconds

/// Nanoseconds, or 0 for what is no usable time (llround() of it would be undefined).
std::int64_t nanoseconds(double seconds) {
  return seconds > 0.0 && seconds <= kLongestS ? std::llround(seconds * 1e9) : 0;
}
}  // namespace

SampleClock::SampleClock(double sample_time_s, double start_time_s)
    : sample_time_s_(sample_time_s),
      sample_ns_(nanoseconds(sample_time_s)),
      start_ns_(nanoseconds(start_time_s)) {
  require(sample_ns_ > 0, "sampling.sample_time_s", "at least 1e-9 s");
  require(start_ns_ > 0, "start_time_s", "a time > 0 (0 is special to rosbag and tf2)");
}

std::uint32_t SampleClock::firstStepAt(std::int64_t time_ns) const {
  if (time_ns <= start_ns_) return 0;
  const std::int64_t elapsed = time_ns - start_ns_;
  const std::int64_t step = elapsed / sample_ns_ + (elapsed % sample_ns_ != 0);
  constexpr std::int64_t kLast = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::min(step, kLast));
}

// The sample time in nanoseconds may itself be rounded (Ts = 1/3 s): only the ratio of what was
// written is free of drift.
std::uint32_t SampleClock::firstStepAtHours(double time_h) const {
  constexpr double kLast = std::numeric_limits<std::uint32_t>::max();
  const double samples = time_h * 3600.0 / sample_time_s_;
  const double rounding = std::min(0.5, 1e-6 / sample_time_s_ + 1e-12 * samples);
  if (!(samples > rounding)) return 0;
  return static_cast<std::uint32_t>(std::min(std::ceil(samples - rounding), kLast));
}

double SampleClock::hoursAt(std::uint32_t step) const {
  return static_cast<double>(step * sample_ns_) * 1e-9 / 3600.0;
}

}  // namespace fpc
