// Keeps a stray message with a large run_id from taking over a running loop.
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace fpc {

/// Every plant start or reset has a larger run_id, announced by plant_info. A run that nobody
/// announced is admitted only after it has gone on for half a second while the present one was
/// silent.
class RunGuard {
 public:
  void announce(std::uint64_t run_id) { announced_ = run_id; }
  /// False: to be dropped. Messages of earlier runs pass: the receiver's StepGate drops and counts
  /// them.
  bool admits(std::uint64_t run_id, ros::WallTime now) {
    if (run_id < present_) return true;
    if (run_id == present_ || run_id == announced_) {
      suspect_ = 0;
    } else if (run_id != suspect_) {
      suspect_ = run_id;
      since_ = now;
      return false;
    } else if ((now - since_).toSec() < 0.5) {
      return false;
    }
    present_ = run_id;
    return true;
  }

 private:
  std::uint64_t announced_{}, present_{}, suspect_{};
  ros::WallTime since_;
};

}  // namespace fpc
