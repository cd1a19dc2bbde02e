// The controller's eye on its optimizer: when its answer stays away, the base action goes to the
// plant instead.
#pragma once

#include <cstdint>

#include "config/loop_file.hpp"
#include "fmbpc/base/exchange.hpp"
#include "runtime/own_wait.hpp"

namespace fpc {

/// Lockstep waits for ever. Paced takes over after `timeout_s` of wall time in which this process
/// runs (OwnWait). Realtime
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
  double deadline() const { return patient_ ? kInfinity : wait_.nextLook(); }
  bool degraded() const { return degraded_; }
  /// Waits for an answer that has been due for longer than the time-out (lockstep as well).
  bool waitsInVain(double now_s) const { return wait_.isOpen() && now_s - asked_s_ > timeout_s_; }
  std::uint64_t takenOver() const { return taken_over_; }

 private:
  bool patient_;
  double timeout_s_;
  OwnWait wait_;  // open: asked, and neither answered nor taken over
  StepHeader sample_;
  double asked_s_{};
  bool degraded_{false}, heard_{false};
  std::uint64_t taken_over_{};
};

}  // namespace fpc
