#include "ros/float64_field.hpp"

#include <fmbpc/Setpoint.h>

#include <cmath>
#include <utility>

#include "ros/queues.hpp"
#include "ros/topics.hpp"

namespace fpc {

Float64Field::Float64Field(ros::NodeHandle node, const LoopFile& loop, std::string name)
    : Node(node, loop, std::move(name)),
      timeout_s_(loop.gateway.stale_s),
      setpoint_(
          node.advertise<fmbpc::Setpoint>(topics::kSetpoint, queueOf(ListenerKind::kViewer))) {
  const GatewayParams& gateway = loop.gateway;
  const std::size_t n_y = gateway.outputs.size();
  for (std::size_t i = 0; i < n_y; ++i) {
    listen(node, gateway.outputs[i].topic, signals_, i);
    forwardSetpoint(node, gateway.outputs[i].setpoint_topic, loop.plant_info.outputs[i].name);
  }
  for (std::size_t i = 0; i < gateway.disturbances.size(); ++i)
    listen(node, gateway.disturbances[i].topic, signals_, n_y + i);
  for (std::size_t i = 0; i < gateway.inputs.size(); ++i) {
    listen(node, gateway.inputs[i].readback_topic, positions_, i);
    efforts_.push_back(node.advertise<std_msgs::Float64>(gateway.inputs[i].topic,
                                                         queueOf(ListenerKind::kPeer), true));
    listenToStrangers(node, gateway.inputs[i].topic);
  }
  listenToEnable(node, gateway.enable_topic);
}

void Float64Field::listenToEnable(ros::NodeHandle& node, const std::string& topic) {
  if (topic.empty()) return;
  const boost::function<void(const ros::MessageEvent<const std_msgs::Bool>&)> enable =
      [this](const ros::MessageEvent<const std_msgs::Bool>& event) {
        if (mayPass(topics::kEnable, event.getPublisherName()))
          enabled_ = event.getConstMessage()->data != 0;
      };
  subscribers_.push_back(
      node.subscribe<std_msgs::Bool>(topic, queueOf(ListenerKind::kPeer), enable));
}

void Float64Field::listen(ros::NodeHandle& node, const std::string& topic, std::vector<Reading>& to,
                          std::size_t index) {
  if (topic.empty()) return;
  TagOwner& owner = owners_.emplace_back(node.resolveName(topic), timeout_s_);
  const boost::function<void(const ros::MessageEvent<const std_msgs::Float64>&)> keep =
      [this, &to, &owner, index](const ros::MessageEvent<const std_msgs::Float64>& event) {
        const double value = event.getConstMessage()->data;
        if (!mayPass(topics::kTags, event.getPublisherName())) return;
        if (!admits(owner, event.getPublisherName(), value)) return;
        const Reading reading{index, value, steadyNow()};
        for (Reading& known : to)
          if (known.index == index) {
            known = reading;
            return;
          }
        to.push_back(reading);
      };
  subscribers_.push_back(node.subscribe<std_msgs::Float64>(topic, queueOf(ListenerKind::kPeer),
                                                           keep, ros::VoidConstPtr(),
                                                           ros::TransportHints().tcpNoDelay()));
}

/// Whoever else commands the plant; what is published here itself comes back as well.
void Float64Field::listenToStrangers(ros::NodeHandle& node, const std::string& topic) {
  const std::string& own = ros::this_node::getName();
  TagOwner& owner = owners_.emplace_back(node.resolveName(topic), timeout_s_, own);
  const boost::function<void(const ros::MessageEvent<const std_msgs::Float64>&)> look =
      [this, &owner, own](const ros::MessageEvent<const std_msgs::Float64>& event) {
        if (event.getPublisherName() != own) admits(owner, event.getPublisherName(), 0.0);
      };
  subscribers_.push_back(
      node.subscribe<std_msgs::Float64>(topic, queueOf(ListenerKind::kPeer), look));
}

bool Float64Field::admits(TagOwner& owner, const std::string& publisher, double value) {
  const double now_s = steadyNow();
  if (owner.admits(publisher, now_s, std::isfinite(value))) {
    ++heard_;
    return true;
  }
  ++strange_;
  if (log_.pass()) ROS_ERROR("%s", owner.problem(now_s).c_str());
  return false;
}

std::string Float64Field::problem() const {
  for (const TagOwner& owner : owners_) {
    std::string words = owner.problem(steadyNow());
    if (!words.empty()) return words;
  }
  return "";
}

/// What others ask in the way of the pid package becomes a setpoint of the exchange.
void Float64Field::forwardSetpoint(ros::NodeHandle& node, const std::string& topic,
                                   const std::string& output) {
  if (topic.empty()) return;
  const boost::function<void(const ros::MessageEvent<const std_msgs::Float64>&)> forward =
      [this, output](const ros::MessageEvent<const std_msgs::Float64>& event) {
        if (!mayPass(topics::kSetpoint, event.getPublisherName())) return;
        const double value = event.getConstMessage()->data;
        if (!std::isfinite(value)) {
          ++strange_;
          if (setpoint_log_.pass())
            ROS_WARN("setpoint of %s by %s dropped: expected a finite number", output.c_str(),
                     event.getPublisherName().c_str());
          return;
        }
        fmbpc::Setpoint setpoint;
        setpoint.name = {output};
        setpoint.value = {value};
        setpoint.mode = fmbpc::Setpoint::OVERRIDE;
        setpoint_.publish(setpoint);
      };
  subscribers_.push_back(
      node.subscribe<std_msgs::Float64>(topic, queueOf(ListenerKind::kViewer), forward));
}

void Float64Field::exchange(PlantGateway& gateway, bool automatic, double now_s) {
  if (enabled_) gateway.remote(*enabled_, now_s);
  enabled_.reset();
  for (const Reading& reading : signals_) gateway.sense(reading.index, reading.value, reading.at_s);
  for (const Reading& reading : positions_)
    gateway.readBack(static_cast<Eigen::Index>(reading.index), reading.value, reading.at_s);
  signals_.clear();
  positions_.clear();
  if (!automatic || !gateway.commands() || gateway.commandNumber() == told_) return;
  told_ = gateway.commandNumber();
  for (std::size_t i = 0; i < efforts_.size(); ++i) {
    std_msgs::Float64 msg;
    msg.data = gateway.command()[static_cast<Eigen::Index>(i)];
    efforts_[i].publish(msg);
  }
  gateway.confirm(told_, now_s);
}

std::vector<std::pair<std::string, std::uint64_t>> Float64Field::counts() const {
  std::vector<std::pair<std::string, std::uint64_t>> counts = {
      {"values received", heard_},
      {"values of strangers: a second publisher's, commands, setpoints that are not finite",
       strange_},
      {"commands sent", told_}};
  for (const auto& [what, count] : authority().refused())
    counts.emplace_back("refused: " + what, count);
  return counts;
}

}  // namespace fpc
