// The health of a node, for programs on loop_state and for people on /diagnostics: both from one
// source, so that they never disagree.
#pragma once

#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "ros/diagnostics.hpp"
#include "ros/steady_timer.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/health.hpp"

namespace fpc {

class HealthReporter {
 public:
  struct Source {
    std::function<Health(double now_s)> health;
    std::function<StepHeader()> sample;                ///< the latest
    std::function<void(Diagnostics::Status&)> values;  ///< counters
  };
  /// `summary`: it speaks for the whole loop (the plant).
  HealthReporter(ros::NodeHandle node, const ros::NodeHandle& private_node,
                 const std::string& title, const std::string& hardware_id, bool summary,
                 Source source);
  /// Events of the sample that was answered last: kept for the run, and logged.
  void say(const std::vector<Event>& events);
  /// Looks now instead of within a quarter of a second.
  void look();
  /// At once, before the process ends: nothing moves any more.
  void sayLast(const std::string& words);

 private:
  void publish();
  void fill(Diagnostics::Status& status) const;

  Source source_;
  std::string name_;
  bool summary_;
  Health shown_;
  Hysteresis hysteresis_{1.0};
  double published_s_{-1e9};
  EventList events_;
  std::uint64_t run_id_{};
  WallThrottle log_{1.0}, events_log_{1.0};
  ros::Publisher publisher_;
  Diagnostics diagnostics_;
  SteadyTimer timer_;
};

}  // namespace fpc
