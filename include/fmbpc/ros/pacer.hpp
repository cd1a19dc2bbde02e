// When the plant may move on: at once (lockstep), after a least time (paced), or on the wall clock
// (realtime).
#pragma once

#include <ros/time.h>

#include <cstdint>

#include "fmbpc/config/loop_file.hpp"

namespace fpc {

/// Deadlines on the wall clock. Pure: time is passed in.
class Pacer {
 public:
  /// `period_s`: wall time per sample, sample time / speedup.
  Pacer(Pace pace, double period_s) : pace_(pace), period_(period_s) {}

  Pace pace() const { return pace_; }
  bool timed() const { return pace_ != Pace::kLockstep; }
  /// The clock starts anew: the sample on the table is as if sent at `now` (start, reset, after a
  /// pause).
  void restart(ros::WallTime now) { deadline_ = now + period_; }
  /// A sample was sent: sets its deadline. Realtime keeps its grid; when the plant itself is late
  /// by more than a whole sample the grid slips, so that controllers always get their full
  /// interval.
  void sent(ros::WallTime now);
  bool due(ros::WallTime now) const { return !timed() || now >= deadline_; }
  /// Time to the deadline, at least a microsecond (a timer needs a period).
  ros::WallDuration remaining(ros::WallTime now) const;
  std::uint64_t slips() const { return slips_; }

 private:
  Pace pace_;
  ros::WallDuration period_;
  ros::WallTime deadline_;
  std::uint64_t slips_{};
};

}  // namespace fpc
