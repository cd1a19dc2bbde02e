// A plant behind std_msgs/Float64 topics, one per signal, as the `pid` package has them: state,
// control_effort, setpoint, pid_enable.
#pragma once

#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "ros/field.hpp"
#include "ros/node.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/tag_owner.hpp"

namespace fpc {

/// A command counts as received once it is published: where inputs are not read back, nobody knows
/// better. Who may say that the plant's own hand has the inputs, set setpoints, and speak for the
/// plant: loop.publishers.enable, .setpoint, .tags.
class Float64Field : public Field, private Node {
 public:
  /// `name`: of the gateway.
  Float64Field(ros::NodeHandle node, const LoopFile& loop, std::string name);
  void exchange(PlantGateway& gateway, bool automatic, double now_s) override;
  /// A tag that two nodes publish, a command of a stranger.
  std::string problem() const override;
  std::vector<std::pair<std::string, std::uint64_t>> counts() const override;

 private:
  struct Reading {
    std::size_t index;
    double value, at_s;
  };
  void listen(ros::NodeHandle& node, const std::string& topic, std::vector<Reading>& to,
              std::size_t index);
  void listenToStrangers(ros::NodeHandle& node, const std::string& topic);
  bool admits(TagOwner& owner, const std::string& publisher, double value);
  void listenToEnable(ros::NodeHandle& node, const std::string& topic);
  void forwardSetpoint(ros::NodeHandle& node, const std::string& topic, const std::string& output);

  std::vector<Reading> signals_, positions_;  // since the last exchange
  std::optional<bool> enabled_;
  std::uint64_t told_{}, heard_{}, strange_{};
  double timeout_s_;
  std::deque<TagOwner> owners_;
  WallThrottle log_{1.0}, setpoint_log_{1.0};
  ros::Publisher setpoint_;
  std::vector<ros::Publisher> efforts_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace fpc
