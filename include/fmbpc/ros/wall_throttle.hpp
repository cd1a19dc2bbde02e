// Lets a log line through once per period of wall time (the throttle of rosconsole goes by
// simulated time).
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace fpc {

class WallThrottle {
 public:
  explicit WallThrottle(double period_s) : period_(period_s) {}
  /// True if nothing has passed within the last period.
  bool pass() {
    const ros::WallTime now = ros::WallTime::now();
    if (!last_.isZero() && now - last_ < period_) return false;
    last_ = now;
    return true;
  }

 private:
  ros::WallDuration period_;
  ros::WallTime last_;
};

}  // namespace fpc
