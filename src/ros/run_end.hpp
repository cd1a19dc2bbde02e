// How a launch ends by itself: when the run is recorded, or cannot begin, every node of it ends.
#pragma once

#include <ros/ros.h>
#include <std_msgs/String.h>

#include <string>

#include "ros/topics.hpp"

namespace fpc {

/// Parameter ~end_with_run (default false): the process ends when somebody says `run_end`.
class RunEndListener {
 public:
  RunEndListener(ros::NodeHandle node, const ros::NodeHandle& private_node) {
    if (!private_node.param("end_with_run", false)) return;
    const boost::function<void(const std_msgs::String::ConstPtr&)> end =
        [](const std_msgs::String::ConstPtr&) { ros::shutdown(); };
    subscriber_ = node.subscribe<std_msgs::String>(topics::kRunEnd, 1, end);
  }

 private:
  ros::Subscriber subscriber_;
};

/// Says it, latched; stay alive for a moment after it.
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
