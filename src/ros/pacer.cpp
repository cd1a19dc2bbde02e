#include "fmbpc/ros/pacer.hpp"

#include <algorithm>

namespace fpc {

void Pacer::sent(ros::WallTime now) {
  if (pace_ != Pace::kRealtime) return restart(now);
  deadline_ += period_;
  if (deadline_ >= now) return;
  ++slips_;
  restart(now);
}

ros::WallDuration Pacer::remaining(ros::WallTime now) const {
  return std::max(ros::WallDuration(1e-6), deadline_ - now);
}

}  // namespace fpc
