#include "runtime/optimizer_watch.hpp"

#include <algorithm>

namespace fpc {

OptimizerWatch::OptimizerWatch(Pace pace, double period_s, double timeout_s)
    : patient_(pace == Pace::kLockstep),
      timeout_s_(std::min(timeout_s, 1.0)),
      wait_(pace == Pace::kRealtime ? OwnWait(std::min(timeout_s, 0.5 * period_s), 1)
                                    : OwnWait(timeout_s)) {}

bool OptimizerWatch::asked(const StepHeader& sample, double now_s) {
  if (degraded_ && heard_) degraded_ = false;
  heard_ = false;
  sample_ = sample;
  asked_s_ = now_s;
  wait_.begin(now_s);
  if (!degraded_) return false;
  wait_.end();
  ++taken_over_;
  return true;
}

void OptimizerWatch::answered(const StepHeader& sample) {
  if (sample.run_id != sample_.run_id || sample.step != sample_.step) return;
  wait_.end();
  heard_ = true;
}

bool OptimizerWatch::mustTakeOver(double now_s) {
  if (patient_ || !wait_.isOver(now_s)) return false;
  wait_.end();
  degraded_ = true;
  ++taken_over_;
  return true;
}

}  // namespace fpc
