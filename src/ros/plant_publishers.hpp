// Everything that a simulated plant says: who it is, its samples, the clock, signals, effects of
// disturbances.
#pragma once

#include <fmbpc/Measurement.h>
#include <ros/ros.h>

#include <cstdint>

#include "fmbpc/plant/simulation.hpp"
#include "ros/signal_publishers.hpp"

namespace fpc {

class PlantPublishers {
 public:
  PlantPublishers(ros::NodeHandle node, const Simulation& simulation, bool publish_clock);

  /// plant_info of the present run, and the clock at its sample 0 (both latched).
  void introduce(const Simulation& simulation);
  /// The present sample.
  void sample(const Simulation& simulation);
  /// The measurement once more.
  void resend();
  std::uint64_t resent() const { return resent_; }

 private:
  void clock(std::int64_t time_ns);
  void signals(const Simulation& simulation);

  ros::Publisher info_, measurement_, state_, effect_, clock_;
  SignalPublishers signals_;
  fmbpc::Measurement last_;
  std::uint64_t resent_{};
};

}  // namespace fpc
