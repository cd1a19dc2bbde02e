#include "ros/registration.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <ros/connection_manager.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <cstdlib>
#include <utility>

#include "ros/topics.hpp"

namespace fpc {
namespace {

using XmlRpc::XmlRpcValue;

constexpr int kEachLook = 8;     // so often; then every so many, for one whom nothing helps
constexpr int kFirstLooks = 20;  // looks that a first registration may take

XmlRpcValue request(const std::vector<std::string>& arguments) {
  XmlRpcValue all;
  all[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i) all[static_cast<int>(i) + 1] = arguments[i];
  return all;
}

/// One call of the master's interface, the caller's name first.
bool tell(const std::string& method, const std::vector<std::string>& arguments) {
  XmlRpcValue payload;
  return ask(ros::master::getURI(), method, request(arguments), payload);
}

/// One call of this node's own interface: what roscpp keeps to itself it tells and does for others.
bool askSelf(const char* method, const XmlRpcValue& arguments, XmlRpcValue& payload) {
  return ask(ros::XMLRPCManager::instance()->getServerURI(), method, arguments, payload);
}

/// [[topic, [node, ...]], ...]
std::map<std::string, std::set<std::string>> byTopic(XmlRpcValue& list) {
  std::map<std::string, std::set<std::string>> nodes;
  for (int i = 0; i < list.size(); ++i)
    for (int j = 0; j < list[i][1].size(); ++j)
      nodes[std::string(list[i][0])].insert(std::string(list[i][1][j]));
  return nodes;
}

bool has(const std::map<std::string, std::set<std::string>>& nodes, const std::string& topic,
         const std::string& node) {
  const auto found = nodes.find(topic);
  return found != nodes.end() && found->second.count(node) > 0;
}

/// False: the TCP connection that roscpp describes so ("... on port N to [... on socket M]") has
/// ended, and it waits, up to 20 s, before it tries again.
bool isEstablished(const std::string& words) {
  const auto port = words.find("on port "), socket = words.rfind("on socket ");
  if (port == std::string::npos || socket == std::string::npos) return true;  // no TCP
  const int descriptor = std::atoi(words.c_str() + socket + 10);
  sockaddr_in here{};
  tcp_info info{};
  socklen_t size = sizeof here, info_size = sizeof info;
  return getsockname(descriptor, reinterpret_cast<sockaddr*>(&here), &size) == 0 &&
         ntohs(here.sin_port) == std::atoi(words.c_str() + port + 8) &&
         getsockopt(descriptor, IPPROTO_TCP, TCP_INFO, &info, &info_size) == 0 &&
         info.tcpi_state == TCP_ESTABLISHED;
}

/// Addresses of the publishers that this process is connected to, by topic; false: unknown.
bool connected(std::map<std::string, std::set<std::string>>& to) {
  XmlRpcValue info;
  if (!askSelf("getBusInfo", request({}), info)) return false;
  for (int i = 0; i < info.size(); ++i)
    if (std::string(info[i][2]) == "i" && isEstablished(info[i][6]))
      to[std::string(info[i][4])].insert(std::string(info[i][1]));
  return true;
}

}  // namespace

KeptParameters::KeptParameters(const ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue own;
  const std::string& space = private_node.getNamespace();
  if (ros::param::get(space, own)) keep(space, own);
  for (const char* name : {topics::kLoopText, topics::kLoopName, "/use_sim_time"}) {
    std::string key;
    XmlRpc::XmlRpcValue value;
    if (private_node.searchParam(name, key) && ros::param::get(key, value)) values_[key] = value;
  }
}

// One call for all of them: each takes the master a third of a millisecond, at the start of a loop.
void KeptParameters::keep(const std::string& name, XmlRpc::XmlRpcValue& value) {
  if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    values_[name] = value;
    return;
  }
  for (auto& [key, inner] : value) keep(name + "/" + key, inner);
}

bool KeptParameters::putBack() const {
  bool any = false;
  for (const auto& [name, value] : values_) {
    if (ros::param::has(name)) continue;
    ros::param::set(name, value);
    any = true;
  }
  return any;
}

Links::Links()
    : services_at_("rosrpc://" + ros::network::getHost() + ":" +
                   std::to_string(ros::ConnectionManager::instance()->getTCPPort())) {}

bool Links::lacks(const std::string& what, const std::string& node) {
  const auto known = before_.find(what);
  const int looks = known == before_.end() ? 1 : known->second.looks + 1;
  missing_[what] = {looks, node};
  return looks > 1 && (looks <= kEachLook || looks % kEachLook == 0);
}

bool Links::isForgotten(const std::string& what, bool known) {
  if (known) known_.insert(what);
  if (known || !lacks(what)) return false;
  return known_.count(what) > 0 || missing_[what].looks > kFirstLooks;
}

Links::Master Links::look(const std::vector<std::string>& spaces, NodeAddresses& addresses) try {
  if (!ros::ok()) return Master::kAnswers;
  XmlRpcValue state;
  if (!ask(ros::master::getURI(), "getSystemState", request({}), state)) return Master::kSilent;
  before_ = std::exchange(missing_, {});
  registered_ = 0;
  const std::string& known = addresses.of(ros::this_node::getName());
  if (!known.empty() && known != ros::XMLRPCManager::instance()->getServerURI())
    return Master::kAnswers;  // another process has its name now, and this one is told to end
  const ByTopic publishers = byTopic(state[0]);
  lookAtTopics(publishers, byTopic(state[1]));
  lookAtServices(byTopic(state[2]), spaces);
  lookAtPublishers(publishers, addresses);
  return registered_ > 0 ? Master::kForgot : Master::kAnswers;
} catch (const XmlRpc::XmlRpcException&) {  // an answer that is none
  return Master::kSilent;
}

void Links::lookAtTopics(const ByTopic& publishers, const ByTopic& subscribers) {
  const std::string &me = ros::this_node::getName(),
                    &uri = ros::XMLRPCManager::instance()->getServerURI();
  std::vector<std::string> names;
  ros::TopicManager::instance()->getAdvertisedTopics(names);
  for (const std::string& topic : names)
    if (isForgotten("publishes " + topic, has(publishers, topic, me)))
      if (const auto publication = ros::TopicManager::instance()->lookupPublication(topic))
        registered_ += tell("registerPublisher", {topic, publication->getDataType(), uri}) ? 1 : 0;
  names.clear();  // the next call appends
  ros::TopicManager::instance()->getSubscribedTopics(names);
  for (const std::string& topic : names)
    if (isForgotten("subscribes " + topic, has(subscribers, topic, me)))
      registered_ += tell("registerSubscriber", {topic, "*", uri}) ? 1 : 0;
}

/// roscpp has no list of a node's services: all names that a node of ours may have are tried, each
/// by a search through all services of the process. So a name that the master has not and that was
/// not there before is tried in every eighth look.
bool Links::serves(const std::string& service, bool listed) {
  if (listed) return true;
  const std::string what = "serves " + service;
  const bool expected = known_.count(what) > 0 || before_.count(what) > 0;
  return (expected || looks_ % kEachLook == 0) &&
         ros::ServiceManager::instance()->lookupServicePublication(service) != nullptr;
}

void Links::lookAtServices(const ByTopic& services, const std::vector<std::string>& spaces) {
  for (const std::string& space : spaces)
    for (const char* name :
         {topics::kPause, topics::kStep, topics::kReset, topics::kManual, topics::kAdapt,
          topics::kManualInput, topics::kHold, topics::kCandidate, "set_parameters", "get_loggers",
          "set_logger_level"}) {
      const std::string service = space + "/" + name;
      const bool listed = has(services, service, ros::this_node::getName());
      if (serves(service, listed) && isForgotten("serves " + service, listed))
        registered_ += tell("registerService",
                            {service, services_at_, ros::XMLRPCManager::instance()->getServerURI()})
                           ? 1
                           : 0;
    }
  ++looks_;
}

void Links::lookAtPublishers(const ByTopic& publishers, NodeAddresses& addresses) {
  ByTopic to;
  if (!connected(to)) return;
  std::vector<std::string> names;
  ros::TopicManager::instance()->getSubscribedTopics(names);
  for (const std::string& topic : names) {
    const auto found = publishers.find(topic);
    if (found == publishers.end()) continue;
    XmlRpcValue kept = request({topic}), done;
    kept[2].setSize(0);
    for (const std::string& uri : to[topic]) kept[2][kept[2].size()] = uri;
    XmlRpcValue all = kept;
    bool incomplete = false;
    for (const std::string& node : found->second) {
      const std::string& uri = addresses.of(node);
      if (node == ros::this_node::getName() || uri.empty() || to[topic].count(uri) > 0) continue;
      if (!answersAt(uri, 0.5)) continue;  // whoever cannot be reached is told of elsewhere
      all[2][all[2].size()] = uri;
      incomplete = lacks(topic + " of " + node, node) || incomplete;
    }
    // The first drops a connection that roscpp has given up for now.
    if (incomplete && askSelf("publisherUpdate", kept, done)) askSelf("publisherUpdate", all, done);
  }
}

std::string Links::missing(const std::set<std::string>& members) const {
  std::string words;
  for (const auto& [what, item] : missing_)
    if (item.looks > 2 && members.count(item.node) > 0) words += (words.empty() ? "" : ", ") + what;
  return words;
}

}  // namespace fpc
