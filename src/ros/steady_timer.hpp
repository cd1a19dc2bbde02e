// Timers on the steady clock. roscpp keeps those of a process in one list, which it searches at
// each tick of each: in a process of many loops that took most of its time.
#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <utility>

namespace fpc {

struct TimerState;
class TimerThread;

/// Its handler runs in the callback queue of its node, and never after stop() or the destructor.
/// All methods are called from the thread that turns that queue.
class SteadyTimer {
 public:
  enum class Kind { kPeriodic, kOnce };
  SteadyTimer() = default;  ///< none
  /// Not started yet. `handler` lets nothing through (callGuarded()).
  SteadyTimer(const ros::NodeHandle& node, double period_s, std::function<void()> handler,
              Kind kind = Kind::kPeriodic);
  ~SteadyTimer() { stop(); }
  SteadyTimer(SteadyTimer&&) = default;
  SteadyTimer& operator=(SteadyTimer&& other);

  /// The same timer, started.
  SteadyTimer started() && {
    start();
    return std::move(*this);
  }
  /// Nothing if it runs; else it is due a period from now.
  void start();
  /// It is due so many seconds from now, whether it runs or not.
  void startIn(double seconds);
  void stop();

 private:
  std::shared_ptr<TimerThread> thread_;  // of the process: lives as long as any timer
  std::shared_ptr<TimerState> state_;
};

}  // namespace fpc
