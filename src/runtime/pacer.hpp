// When the plant may move on: at once (lockstep), after a least time (paced), or on the clock
// (realtime).
#pragma once

#include <cstdint>

#include "config/loop_file.hpp"

namespace fpc {

/// Deadlines [s] on a steady clock of the caller's. Pure: time is passed in.
class Pacer {
 public:
  /// `period_s`: wall time per sample, sample time / speedup.
  Pacer(Pace pace, double period_s) : pace_(pace), period_s_(period_s) {}

  Pace pace() const { return pace_; }
  double period() const { return period_s_; }
  bool timed() const { return pace_ != Pace::kLockstep; }
  /// The clock starts anew: the sample on the table is as if sent at `now_s` (start, reset, after a
  /// pause).
  void restart(double now_s) { deadline_s_ = now_s + period_s_; }
  /// A sample was sent: sets its deadline. Realtime keeps its grid; when the plant itself is late
  /// by more than a whole sample the grid slips, so that controllers always get their full
  /// interval.
  void sent(double now_s);
  bool due(double now_s) const { return !timed() || now_s >= deadline_s_; }
  double deadline() const { return deadline_s_; }
  /// Time to the deadline, at least a microsecond (a timer needs a period).
  double remaining(double now_s) const;
  std::uint64_t slips() const { return slips_; }

 private:
  Pace pace_;
  double period_s_;
  double deadline_s_{};
  std::uint64_t slips_{};
};

}  // namespace fpc
