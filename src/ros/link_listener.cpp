#include "ros/link_listener.hpp"

#include <set>
#include <utility>

#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {
namespace {

constexpr char kLoopLinks[] = "loop_links";

std::vector<LoopLink> linksOf(const ros::NodeHandle& private_node) {
  std::string key, text;
  if (!private_node.searchParam(kLoopLinks, key) || !private_node.getParam(key, text)) return {};
  return text.empty() ? std::vector<LoopLink>{} : parseLinks(text, key);
}

/// Loops of a plant are beside each other.
std::string besideOf(const ros::NodeHandle& node, const std::string& loop) {
  const std::string& own = node.getNamespace();
  return own.substr(0, own.rfind('/') + 1) + loop + "/";
}

}  // namespace

LinkListener::LinkListener(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                           Pace pace, LinkInbox::Of of, std::function<void()> heard)
    : inbox_(linksOf(private_node), of, pace == Pace::kLockstep), heard_(std::move(heard)) {
  for (const auto& [from, action] : inbox_.sources()) listen(node, from, action);
}

void LinkListener::listen(ros::NodeHandle node, const std::string& from, bool action) {
  const auto hint = ros::TransportHints().tcpNoDelay();
  const std::uint32_t queue = queueOf(ListenerKind::kRecord);
  const auto take = [this, from, action](const StepHeader& sample, VectorRef values) {
    inbox_.hear(from, action, sample, values);
    heard_();
  };
  const auto vectorOf = [](const std::vector<double>& values) {
    return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  const auto headerOf = [](const auto& msg) {
    return StepHeader{fromStamp(msg.header.stamp), msg.run_id, msg.step};
  };
  if (action)
    subscribers_.push_back(node.subscribe<fmbpc::ControlAction>(
        besideOf(node, from) + topics::kControlAction, queue,
        [=](const fmbpc::ControlAction::ConstPtr& msg) {
          take(headerOf(*msg), vectorOf(msg->input));
        },
        ros::VoidConstPtr(), hint));
  else
    subscribers_.push_back(node.subscribe<fmbpc::Measurement>(
        besideOf(node, from) + topics::kMeasurement, queue,
        [=](const fmbpc::Measurement::ConstPtr& msg) {
          take(headerOf(*msg), vectorOf(msg->outputs));
        },
        ros::VoidConstPtr(), hint));
}

std::vector<std::string> LinkListener::missing() const {
  std::vector<std::string> topics;
  for (const ros::Subscriber& subscriber : subscribers_)
    if (subscriber.getNumPublishers() == 0) topics.push_back(subscriber.getTopic());
  return topics;
}

}  // namespace fpc
