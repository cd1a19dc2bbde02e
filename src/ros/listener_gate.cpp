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

bool ListenerGate::open() {
  if (open_) return true;
  const double now_s = steadyNow();
  if (deadline_s_ < 0) deadline_s_ = now_s + kPatience;
  open_ = allConnected() || now_s >= deadline_s_;
  return open_;
}

}  // namespace fpc
