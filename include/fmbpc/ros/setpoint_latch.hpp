// The topic setpoint_active: what the operator asked and what stands, for controllers that join
// late.
#pragma once

#include <fmbpc/Setpoint.h>
#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fmbpc/ros/node.hpp"
#include "fmbpc/ros/setpoint_keeper.hpp"

namespace fpc {

/// Listens to `setpoint`. Publishes what stands when it changes; whoever connects hears it at once,
/// with what is still to come. If nothing stands, that is said by a release without names.
class SetpointLatch : public Node {
 public:
  SetpointLatch(ros::NodeHandle node, std::vector<std::string> output_names);
  void advance(std::int64_t time_ns);  ///< a sample was measured
  void clear() { keeper_.clear(); }    ///< a new run has begun
  using Node::refused;

 private:
  void onSetpoint(const fmbpc::Setpoint::ConstPtr& msg);
  void onListener(const ros::SingleSubscriberPublisher& listener);
  std::vector<Command> standing() const;

  SetpointKeeper keeper_;
  ros::Publisher active_;
  ros::Subscriber subscriber_;
};

}  // namespace fpc
