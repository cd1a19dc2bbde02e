// Everything that any plant says: who it is, its samples, the clock, signals.
#pragma once

#include <fmbpc/Measurement.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Clock.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "plant/process.hpp"
#include "ros/hearers.hpp"
#include "ros/signal_publishers.hpp"

namespace fpc {

class PlantPublishers {
 public:
  /// `disturbances`: names of those that have signals.
  PlantPublishers(ros::NodeHandle node, const LoopFile& loop, const PlantInfo& info,
                  const std::vector<std::string>& disturbances);

  PlantPublishers(const PlantPublishers&) = delete;
  PlantPublishers& operator=(const PlantPublishers&) = delete;
  /// A new run: it is introduced, and the clock stands at its sample 0.
  void begin(const Process& process);
  /// plant_info of the present run (latched).
  void introduce(const Process& process);
  /// The present sample, with values of the disturbances named at construction. `mark` may add to
  /// the message what no struct has.
  void sample(const Process& process, VectorRef disturbances,
              const std::function<void(fmbpc::Measurement&)>& mark);
  /// The measurement once more.
  void resend();
  /// What a record is made of.
  std::vector<ros::Publisher> recorded() const { return {info_, measurement_}; }
  std::uint64_t resent() const { return resent_; }

 private:
  void clock(std::int64_t time_ns);
  void signals(const Measurement& now, VectorRef disturbances);

  SampleClock steps_;
  std::string loop_digest_;
  ros::Publisher info_, measurement_, clock_;
  Hearers clock_hearers_;
  SignalPublishers signals_;
  fmbpc::Measurement::ConstPtr last_;
  rosgraph_msgs::Clock now_;
  std::uint64_t resent_{};
};

}  // namespace fpc
