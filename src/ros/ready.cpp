#include "ros/ready.hpp"

#include <utility>

#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {

ReadyPublisher::ReadyPublisher(ros::NodeHandle node, std::string name)
    : name_(std::move(name)),
      publisher_(node.advertise<fmbpc::NodeReady>(topics::kReady, 1, true)) {}

void ReadyPublisher::announce() {
  if (announced_) return;
  announced_ = true;
  fmbpc::NodeReady msg;
  msg.node = name_;
  publisher_.publish(msg);
  ROS_INFO("%s: ready", msg.node.c_str());
}

ReadyListener::ReadyListener(ros::NodeHandle node, const LoopFile& loop, std::string name,
                             const std::vector<std::string>& names)
    : Node(node, loop, std::move(name)) {
  for (const std::string& one : names) missing_.insert(node.resolveName(one));
  subscriber_ = subscribe(node, topics::kReady, queueOf(ListenerKind::kViewer),
                          &ReadyListener::onReady, this);
}

std::vector<std::string> ReadyListener::missing() const {
  return {missing_.begin(), missing_.end()};
}

void ReadyListener::onReady(const fmbpc::NodeReady::ConstPtr& msg, const std::string& publisher) {
  if (speaksFor(topics::kReady, publisher, msg->node)) missing_.erase(msg->node);
}

}  // namespace fpc
