#include "ros/listener_gate.hpp"

#include <ros/master.h>

#include <algorithm>
#include <map>
#include <string>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kPatience = 1.0;  // [s] of wall time

using Counts = std::map<std::string, std::uint32_t>;

Counts countsOf(XmlRpc::XmlRpcValue& topics) {
  Counts counts;
  for (int i = topics.size(); i-- > 0;)
    counts[topics[i][0]] = static_cast<std::uint32_t>(topics[i][1].size());
  return counts;
}

}  // namespace

ListenerGate::ListenerGate(std::vector<ros::Publisher> publishers)
    : publishers_(std::move(publishers)), wait_(kPatience) {}

/// True if the master does not answer.
bool ListenerGate::allConnected() const {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, state, false)) return true;
  Counts publishers = countsOf(state[0]), listeners = countsOf(state[1]);
  return std::all_of(publishers_.begin(), publishers_.end(),
                     [&](const ros::Publisher& p) {
                       return p.getNumSubscribers() >= listeners[p.getTopic()];
                     }) &&
         std::all_of(subscribers_.begin(), subscribers_.end(), [&](const ros::Subscriber& s) {
           return s.getNumPublishers() >= publishers[s.getTopic()];
         });
}

bool ListenerGate::connected() {
  const double now_s = steadyNow();
  if (!wait_.isOpen()) wait_.begin(now_s);
  open_ = open_ || wait_.isOver(now_s);
  if (!open_ && !allConnected()) return false;
  wait_.end();
  return true;
}

}  // namespace fpc
