#include "ros/float64_field.hpp"

#include <fmbpc/Setpoint.h>

#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {

Float64Field::Float64Field(ros::NodeHandle node, const LoopFile& loop)
    : setpoint_(node.advertise<fmbpc::Setpoint>(topics::kSetpoint, topics::kViewQueue)) {
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
    efforts_.push_back(
        node.advertise<std_msgs::Float64>(gateway.inputs[i].topic, topics::kPairQueue, true));
  }
  if (gateway.enable_topic.empty()) return;
  const boost::function<void(const std_msgs::Bool::ConstPtr&)> enable =
      [this](const std_msgs::Bool::ConstPtr& msg) { enabled_ = msg->data != 0; };
  subscribers_.push_back(node.subscribe<std_msgs::Bool>(gateway.enable_topic, 1, enable));
}

void Float64Field::listen(ros::NodeHandle& node, const std::string& topic, std::vector<Reading>& to,
                          std::size_t index) {
  if (topic.empty()) return;
  const boost::function<void(const std_msgs::Float64::ConstPtr&)> keep =
      [this, &to, index](const std_msgs::Float64::ConstPtr& msg) {
        ++heard_;
        for (Reading& known : to)
          if (known.index == index) {
            known = {index, msg->data, steadyNow()};
            return;
          }
        to.push_back({index, msg->data, steadyNow()});
      };
  subscribers_.push_back(node.subscribe<std_msgs::Float64>(
      topic, topics::kPairQueue, keep, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

/// What others ask in the way of the pid package becomes a setpoint of the ring.
void Float64Field::forwardSetpoint(ros::NodeHandle& node, const std::string& topic,
                                   const std::string& output) {
  if (topic.empty()) return;
  const boost::function<void(const std_msgs::Float64::ConstPtr&)> forward =
      [this, output](const std_msgs::Float64::ConstPtr& msg) {
        fmbpc::Setpoint setpoint;
        setpoint.name = {output};
        setpoint.value = {msg->data};
        setpoint.mode = fmbpc::Setpoint::OVERRIDE;
        setpoint_.publish(setpoint);
      };
  subscribers_.push_back(node.subscribe<std_msgs::Float64>(topic, topics::kViewQueue, forward));
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
  return {{"values received", heard_}, {"commands sent", told_}};
}

}  // namespace fpc
