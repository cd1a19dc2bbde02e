// Lets a log line through once per period of wall time (the throttle of rosconsole goes by
// simulated time), and the steady clock by which nodes wait.
#pragma once

#include <ros/time.h>

namespace fpc {

/// Seconds on a clock that nobody sets.
inline double steadyNow() { return ros::SteadyTime::now().toSec(); }

class WallThrottle {
 public:
  explicit WallThrottle(double period_s) : period_s_(period_s) {}
  /// True if nothing has passed within the last period.
  bool pass() {
    const double now_s = steadyNow();
    if (passed_ && now_s - last_s_ < period_s_) return false;
    passed_ = true;
    last_s_ = now_s;
    return true;
  }

 private:
  double period_s_, last_s_{};
  bool passed_{false};
};

}  // namespace fpc
