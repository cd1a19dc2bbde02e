#include "ros/ready.hpp"

#include <utility>

#include "base/text_hash.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr double kLook = 0.01;  // [s] of wall time

}  // namespace

ReadyPublisher::ReadyPublisher(ros::NodeHandle node, const LoopFile& loop, std::string name,
                               std::function<bool()> ready)
    : Node(node, loop, std::move(name)),
      is_ready_(std::move(ready)),
      loop_digest_(textHash(loop.resolved)),
      publisher_(node.advertise<fmbpc::NodeReady>(topics::kReady, 1, true)),
      timer_(guardedTimer(node, kLook, topics::kReady, [this] {
               if (is_ready_()) announce();
             }).started()) {}

void ReadyPublisher::announce() {
  timer_.stop();
  announced_ = true;
  fmbpc::NodeReady msg;
  msg.node = name();
  msg.loop_digest = loop_digest_;
  publisher_.publish(msg);
  ROS_INFO("%s: ready", msg.node.c_str());
}

ReadyListener::ReadyListener(ros::NodeHandle node, const LoopFile& loop, std::string name,
                             const std::vector<std::string>& names)
    : Node(node, loop, std::move(name)), loop_digest_(textHash(loop.resolved)) {
  for (const std::string& one : names) missing_.insert(node.resolveName(one));
  subscriber_ = subscribe(node, topics::kReady, queueOf(ListenerKind::kViewer),
                          &ReadyListener::onReady, this);
}

std::vector<std::string> ReadyListener::missing() const {
  return {missing_.begin(), missing_.end()};
}

void ReadyListener::onReady(const fmbpc::NodeReady::ConstPtr& msg, const std::string& publisher) {
  if (!speaksFor(topics::kReady, publisher, msg->node)) return;
  if (msg->loop_digest.empty() || msg->loop_digest == loop_digest_) {
    strangers_.erase(msg->node);
    missing_.erase(msg->node);
  } else if (missing_.count(msg->node) > 0 && strangers_.insert(msg->node).second) {
    ROS_ERROR("%s: %s is ready for another loop: its loop_text is not this node's", name().c_str(),
              msg->node.c_str());
  }
}

std::string ReadyListener::named(const std::vector<std::string>& missing) const {
  if (missing.empty()) return "controller and listeners";
  if (strangers_.empty()) return join(missing);
  const std::vector<std::string> strangers(strangers_.begin(), strangers_.end());
  return join(missing) + "; another loop_text is read by " + join(strangers);
}

}  // namespace fpc
