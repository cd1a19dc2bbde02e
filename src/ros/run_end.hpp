// How a launch ends by itself: who knows that the run is over says so, and scripts/end_launch.py
// ends the launch.
#pragma once

#include <ros/ros.h>
#include <std_msgs/String.h>

#include <string>

#include "ros/topics.hpp"

namespace fpc {

/// Says it, latched, with the reason; stay alive for a moment after it.
class RunEndPublisher {
 public:
  explicit RunEndPublisher(ros::NodeHandle node)
      : publisher_(node.advertise<std_msgs::String>(topics::kRunEnd, 1, true)) {}
  void say(const std::string& why) {
    std_msgs::String msg;
    msg.data = why;
    publisher_.publish(msg);
  }

 private:
  ros::Publisher publisher_;
};

}  // namespace fpc
