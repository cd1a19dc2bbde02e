#include "ros/node.hpp"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <fmbpc/LoopState.h>
#include <ros/callback_queue.h>
#include <ros/xmlrpc_manager.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <utility>

#include "fmbpc/base/text.hpp"
#include "ros/node_end.hpp"
#include "ros/topics.hpp"
#include "runtime/health.hpp"

namespace fpc {
namespace {

constexpr double kShownMissing = 5.0;      // [s] that a refusal stays in words
constexpr std::size_t kMostLetters = 300;  // of them
constexpr std::size_t kMostCommands = 10;  // refused ones that are told to the record

bool isCommand(const std::string& topic) {
  return topic == topics::kSetpoint || topic == topics::kDisturbance ||
         topic == topics::kManualInput || topic == topics::kSettings || topic == topics::kCandidate;
}

std::string shortened(const std::string& words) {
  return words.size() <= kMostLetters ? words : words.substr(0, kMostLetters) + "...";
}

}  // namespace

Node::Node(const ros::NodeHandle& node, const LoopFile& loop, std::string name)
    : name_(std::move(name)) {
  const std::string& process = ros::this_node::getName();
  Publishers publishers = loop.exchange.publishers;
  publishers[topics::kOperatorState] = publishers[topics::kTracking];  // both are the controller's
  for (auto& [topic, names] : publishers) {
    for (std::string& one : names) one = node.resolveName(one);
    // Nodelets all speak with the name of their manager.
    if (process != name_ && !names.empty()) names.push_back(process);
  }
  authority_ = Authority(std::move(publishers), process != name_ ? process : "");
}

bool Node::mayPass(const char* topic, const std::string& publisher) {
  if (authority_.admits(topic, publisher)) return true;
  if (mayLog(std::string(topic) + " of others"))
    ROS_ERROR("%s: %s of %s dropped: the loop takes it only from %s", name_.c_str(), topic,
              publisher.c_str(), join(authority_.publishersOf(topic)).c_str());
  return false;
}

bool Node::speaksFor(const char* topic, const std::string& publisher, const std::string& node) {
  if (authority_.speaksFor(topic, publisher, node)) return true;
  if (mayLog(std::string(topic) + " for others"))
    ROS_ERROR("%s: %s of %s dropped: it speaks for %s, which must do that itself", name_.c_str(),
              topic, publisher.c_str(), shortened(node).c_str());
  return false;
}

bool Node::mayLog(const std::string& what) { return logs_.emplace(what, 1.0).first->second.pass(); }

void Node::fail(const std::string& what) {
  ROS_FATAL("%s: %s", name_.c_str(), what.c_str());
  exit_code_ = 1;
  endNode(what);
}

void Node::refuse(const char* topic, const std::string& why) {
  ++refused_[topic];
  refusal_ = std::string(topic) + ": " + shortened(why);
  refusal_s_ = steadyNow();
  if (mayLog(topic)) ROS_WARN("%s: message dropped: %s", topic, shortened(why).c_str());
  if (isCommand(topic)) noteCommand(shortened(why));
}

void Node::noteCommand(const std::string& why) {
  if (commands_seen_.size() >= kMostCommands && commands_seen_.count(why) == 0) return;
  commands_seen_.insert(why);
  if (commands_refused_.size() >= kMostCommands) return;  // nobody takes them
  commands_refused_.push_back(eventOf({EventCode::kCommandRefused, why.c_str()}, 0));
}

std::vector<Event> Node::takeRefusedCommands(std::uint32_t step) {
  for (Event& event : commands_refused_) event.first = event.last = step;
  return std::exchange(commands_refused_, {});
}

std::string Node::withRefusal(std::string words, double now_s) const {
  const std::string refusal = refusedLately(now_s);
  if (!refusal.empty()) words += "; refused: " + refusal;
  return words;
}

std::string Node::refusedLately(double now_s) const {
  return refusal_.empty() || now_s - refusal_s_ > kShownMissing ? "" : refusal_;
}

void Node::mishap(const char* topic, const std::string& what) {
  ++refused_[topic];
  if (mayLog(std::string(topic) + " mishap"))
    ROS_ERROR("%s: %s: %s", name_.c_str(), topic, shortened(what).c_str());
}

namespace {

/// Says on loop_state and the diagnostics why a node cannot start.
class Failure {
 public:
  Failure(ros::NodeHandle node, const std::string& why)
      : states_(node.advertise<fmbpc::LoopState>(topics::kLoopState, 1, true)),
        array_(node.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 1, true)) {
    state_.node = ros::this_node::getName();
    state_.mode = static_cast<std::uint8_t>(LoopMode::kFailed);
    state_.word = wordOf(LoopMode::kFailed);
    state_.code = kindOf(EventCode::kCannotStart).name;
    state_.reason = "cannot start: " + why;
    diagnostics_.status.resize(1);
    diagnostics_.status[0].name = state_.node.substr(1) + ": start";
    diagnostics_.status[0].level = diagnostic_msgs::DiagnosticStatus::ERROR;
    diagnostics_.status[0].message = state_.reason;
    say();
  }
  void say() {
    states_.publish(state_);
    array_.publish(diagnostics_);
  }
  bool hasListener() const { return states_.getNumSubscribers() > 0; }

 private:
  fmbpc::LoopState state_;
  diagnostic_msgs::DiagnosticArray diagnostics_;
  ros::Publisher states_, array_;
};

std::atomic<bool> told_to_end{false};

void pause(double seconds) {
  ros::spinOnce();
  ros::WallDuration(seconds).sleep();
  if (told_to_end) ros::shutdown();
}

void untilHeard(const Failure& failure) {
  constexpr double kConnected = 0.5,
                   kInAll = 3.0;  // [s] after somebody has connected, and in all
  const double begun_s = steadyNow();
  double alone_s = begun_s;  // until then
  while (ros::ok() && steadyNow() - alone_s < kConnected && steadyNow() - begun_s < kInAll) {
    if (!failure.hasListener()) alone_s = steadyNow();
    pause(0.05);
  }
}

std::string loopText(const ros::NodeHandle& private_node) {
  std::string key, text;
  if (private_node.searchParam(topics::kLoopText, key)) private_node.getParam(key, text);
  return text;
}

}  // namespace

int failToStart(ros::NodeHandle node, const ros::NodeHandle& private_node, const std::string& why) {
  Failure failure(node, why);
  if (!private_node.param("respawned", false)) {
    untilHeard(failure);
    return 1;
  }
  const std::string text = loopText(private_node);
  ROS_FATAL("%s: waits for another %s", ros::this_node::getName().c_str(), topics::kLoopText);
  while (ros::ok() && loopText(private_node) == text) {
    failure.say();
    pause(RingWatch::kBeat);
  }
  return 1;
}

namespace {

void onShutdownCall(XmlRpc::XmlRpcValue& parameters, XmlRpc::XmlRpcValue& result) {
  if (parameters.getType() == XmlRpc::XmlRpcValue::TypeArray && parameters.size() > 1)
    ROS_WARN("told to end: %s", shortened(std::string(parameters[1])).c_str());
  told_to_end = true;
  result = ros::xmlrpc::responseInt(1, "", 0);
}

}  // namespace

// The first binding of a method counts: roscpp's own, made when the node starts, does not.
void hearShutdown() {
  const auto hear = [](int) { told_to_end = true; };
  std::signal(SIGINT, hear);
  ros::XMLRPCManager::instance()->bind("shutdown", onShutdownCall);
}

void spinUntilShutdown(const std::function<void()>& last) {
  constexpr double kTurn = 0.1, kSent = 0.05;  // [s] as ros::spin(); until the words have left
  while (ros::ok() && !told_to_end)
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(kTurn));
  if (!ros::ok()) return;
  last();
  ros::WallDuration(kSent).sleep();
  ros::shutdown();
}

LoopFile loopParameter(const ros::NodeHandle& private_node) {
  std::string key, text, name = "loop";
  require(private_node.searchParam(topics::kLoopText, key) && private_node.getParam(key, text),
          std::string("parameter ") + topics::kLoopText, "the output of `fmbpc resolve LOOP`");
  if (private_node.searchParam(topics::kLoopName, key)) private_node.getParam(key, name);
  return parseLoop(text, std::filesystem::path(name).stem().string());
}

}  // namespace fpc
