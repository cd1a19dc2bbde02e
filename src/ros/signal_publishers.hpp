// Single numbers on signal/NAME, for rqt_plot and PlotJuggler.
#pragma once

#include <fmbpc/Signal.h>
#include <ros/ros.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ros/hearers.hpp"

namespace fpc {

/// Advertises once; publishes only what somebody listens to.
class SignalPublishers {
 public:
  explicit SignalPublishers(const ros::NodeHandle& node) : node_(node) {}
  /// Index of the signal for publish(), in the order of the calls.
  std::size_t add(const std::string& name);
  std::size_t size() const { return publishers_.size(); }
  void publish(std::size_t index, std::int64_t time_ns, double value);

 private:
  ros::NodeHandle node_;
  std::vector<ros::Publisher> publishers_;
  std::vector<Hearers> hearers_;
  fmbpc::Signal msg_;
};

}  // namespace fpc
