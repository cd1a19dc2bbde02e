#include "ros/link_listener.hpp"

#include <set>
#include <utility>

#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "runtime/plan.hpp"

namespace fpc {
namespace {

template <class Message>
bool isPlanned(const Message& /*msg*/) {
  return true;
}
bool isPlanned(const fmbpc::ControlAction& msg) {
  return isLawsOwn(static_cast<ActionSource>(msg.source));
}

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
  for (const auto& [from, what] : inbox_.sources()) listen(node, from, what);
}

template <class Message, class Read>
void LinkListener::hear(ros::NodeHandle& node, const std::string& from, LoopLink::Of of,
                        const char* topic, Read read) {
  subscribers_.push_back(node.subscribe<Message>(
      besideOf(node, from) + topic, queueOf(ListenerKind::kRecord),
      [=](const typename Message::ConstPtr& msg) {
        inbox_.hear(from, of, {fromStamp(msg->header.stamp), msg->run_id, msg->step}, read(*msg),
                    isPlanned(*msg));
        heard_();
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

void LinkListener::listen(ros::NodeHandle node, const std::string& from, LoopLink::Of of) {
  const auto vectorOf = [](const std::vector<double>& values) {
    return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
  };
  switch (of) {
    case LoopLink::Of::kOutputs:
      return hear<fmbpc::Measurement>(node, from, of, topics::kMeasurement,
                                      [=](const auto& msg) { return vectorOf(msg.outputs); });
    case LoopLink::Of::kInputs:
      return hear<fmbpc::ControlAction>(node, from, of, topics::kControlAction,
                                        [=](const auto& msg) { return vectorOf(msg.input); });
    case LoopLink::Of::kPlan:
      return hear<fmbpc::PredictiveAction>(node, from, of, topics::kPredictiveAction,
                                           [](const auto& msg) { return planOf(fromMsg(msg)); });
  }
}

std::vector<std::string> LinkListener::missing() const {
  std::vector<std::string> topics;
  for (const ros::Subscriber& subscriber : subscribers_)
    if (subscriber.getNumPublishers() == 0) topics.push_back(subscriber.getTopic());
  return topics;
}

}  // namespace fpc
