// The controller's eye on its optimizer: when its answer stays away, the base action goes to the
// plant instead.
#pragma once

#include <cstdint>
#include <limits>

#include "config/loop_file.hpp"
#include "fmbpc/base/ring.hpp"

namespace fpc {

/// Lockstep waits for ever. Paced takes over after `timeout_s` of wall time in which this process
/// runs: it looks ten times, and a look that comes late counts as one, since what held it up (a
/// machine that stands still, or has much else to do) holds the optimizer up as well. Realtime
/// takes over after `timeout_s` or half a sample, whichever is less, on the clock. Once degraded it
/// takes over at once at every sample, until the optimizer answers again: from the next sample on
/// it is trusted. Both answers start from the same measurement and keep the same limits, so that
/// neither change is a bump.
class OptimizerWatch {
 public:
  OptimizerWatch(Pace pace, double period_s, double timeout_s);

  /// A base action for the optimizer went out. True: degraded, send it to the plant now.
  bool asked(const StepHeader& sample, double now_s);
  /// The optimizer's action for a sample was heard.
  void answered(const StepHeader& sample);
  /// A look at deadline() or later. True once per sample: its time is up, send the base action to
  /// the plant.
  bool mustTakeOver(double now_s);
  /// When to look next; infinite: not now.
  double deadline() const;
  bool degraded() const { return degraded_; }
  /// Waits for an answer that has been due for longer than the time-out (lockstep as well).
  bool waitsInVain(double now_s) const { return open_ && now_s - asked_s_ > timeout_s_; }
  std::uint64_t takenOver() const { return taken_over_; }

 private:
  bool patient_;
  int most_looks_;
  double between_looks_s_, timeout_s_;
  StepHeader sample_;
  int looks_{};
  double asked_s_{}, looked_s_{};
  bool open_{false};  // asked, and neither answered nor taken over
  bool degraded_{false}, heard_{false};
  std::uint64_t taken_over_{};
};

}  // namespace fpc
