#include "fmbpc/ros/node.hpp"

#include <filesystem>

#include "fmbpc/ros/topics.hpp"

namespace fpc {

void Node::fail(const std::string& what) {
  ROS_FATAL("%s: %s", ros::this_node::getName().c_str(), what.c_str());
  exit_code_ = 1;
  ros::shutdown();
}

void Node::refuse(const char* topic, const std::string& why) {
  ++refused_[topic];
  if (refuse_log_.pass()) ROS_WARN("%s: message dropped: %s", topic, why.c_str());
}

LoopFile loopParameter(const ros::NodeHandle& node) {
  std::string key, text, name = "loop";
  require(node.searchParam(topics::kLoopText, key) && node.getParam(key, text),
          std::string("parameter ") + topics::kLoopText, "the output of `fmbpc resolve LOOP`");
  if (node.searchParam(topics::kLoopName, key)) node.getParam(key, name);
  return parseLoop(text, std::filesystem::path(name).stem().string());
}

int stayIdle(const ros::NodeHandle& private_node, const std::string& reason) {
  ROS_INFO("%s: nothing to do: %s", ros::this_node::getName().c_str(), reason.c_str());
  if (private_node.param("stay", false)) ros::spin();
  return 0;
}

}  // namespace fpc
