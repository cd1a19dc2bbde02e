#include "ros/listener_gate.hpp"

#include <ros/master.h>

#include <algorithm>
#include <map>
#include <string>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kPatience = 1.0;  // [s] of wall time

/// Number of listeners by topic; empty if the master does not answer.
std::map<std::string, std::uint32_t> listeners() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  std::map<std::string, std::uint32_t> counts;
  if (!ros::master::execute("getSystemState", request, response, state, false)) return counts;
  XmlRpc::XmlRpcValue& subscribers = state[1];
  for (int i = subscribers.size(); i-- > 0;)
    counts[subscribers[i][0]] = static_cast<std::uint32_t>(subscribers[i][1].size());
  return counts;
}

}  // namespace

bool ListenerGate::allConnected() const {
  auto needed = listeners();
  return std::all_of(publishers_.begin(), publishers_.end(), [&](const ros::Publisher& p) {
    return p.getNumSubscribers() >= needed[p.getTopic()];
  });
}

bool ListenerGate::open() {
  if (open_) return true;
  const double now_s = steadyNow();
  if (deadline_s_ < 0) deadline_s_ = now_s + kPatience;
  open_ = allConnected() || now_s >= deadline_s_;
  return open_;
}

}  // namespace fpc
