#include "runtime/pacer.hpp"

#include <algorithm>

namespace fpc {

void Pacer::sent(double now_s) {
  if (pace_ != Pace::kRealtime) return restart(now_s);
  deadline_s_ += period_s_;
  if (deadline_s_ >= now_s) return;
  ++slips_;
  restart(now_s);
}

double Pacer::remaining(double now_s) const { return std::max(1e-6, deadline_s_ - now_s); }

}  // namespace fpc
