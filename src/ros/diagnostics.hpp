// Health of a node on /diagnostics, with the reason in words, once per second of wall time.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "base/step_gate.hpp"
#include "ros/steady_timer.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {

class Diagnostics {
 public:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// `report` fills level, words and values; it is called from the node's own callback queue.
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const std::string& title, const std::string& hardware_id,
              std::function<void(Status&)> report);
  void update() { updater_.force_update(); }

 private:
  diagnostic_updater::Updater updater_;
  WallThrottle log_{1.0};
  SteadyTimer timer_;
};

/// What arrived and was not simply the next sample.
void addCounts(Diagnostics::Status& status, const ArrivalCounts& counts);
/// Messages refused, by topic.
void addRefused(Diagnostics::Status& status, const std::map<std::string, std::uint64_t>& refused);

}  // namespace fpc
