#include "runtime/optimizer_watch.hpp"

#include <algorithm>

namespace fpc {

OptimizerWatch::OptimizerWatch(Pace pace, double period_s, double timeout_s)
    : patient_(pace == Pace::kLockstep),
      most_looks_(pace == Pace::kRealtime ? 1 : 10),
      between_looks_s_(pace == Pace::kRealtime ? std::min(timeout_s, 0.5 * period_s)
                                               : timeout_s / most_looks_),
      timeout_s_(std::min(timeout_s, 1.0)) {}

bool OptimizerWatch::asked(const StepHeader& sample, double now_s) {
  if (degraded_ && heard_) degraded_ = false;
  heard_ = false;
  sample_ = sample;
  asked_s_ = looked_s_ = now_s;
  looks_ = 0;
  open_ = !degraded_;
  if (degraded_) ++taken_over_;
  return degraded_;
}

void OptimizerWatch::answered(const StepHeader& sample) {
  if (sample.run_id != sample_.run_id || sample.step != sample_.step) return;
  open_ = false;
  heard_ = true;
}

double OptimizerWatch::deadline() const {
  return open_ && !patient_ ? looked_s_ + between_looks_s_
                            : std::numeric_limits<double>::infinity();
}

bool OptimizerWatch::mustTakeOver(double now_s) {
  if (now_s < deadline()) return false;
  looked_s_ = now_s;
  if (++looks_ < most_looks_) return false;
  open_ = false;
  degraded_ = true;
  ++taken_over_;
  return true;
}

}  // namespace fpc
