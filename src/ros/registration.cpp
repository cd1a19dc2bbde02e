#include "ros/registration.hpp"

#include <ros/connection_manager.h>
#include <ros/network.h>
#include <ros/publication.h>
#include <ros/service_manager.h>
#include <ros/service_publication.h>
#include <ros/topic_manager.h>
#include <ros/xmlrpc_manager.h>

#include "ros/topics.hpp"

namespace fpc {
namespace {

/// One call of the master's interface, the caller's name first.
bool tell(const std::string& method, const std::vector<std::string>& arguments) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  for (std::size_t i = 0; i < arguments.size(); ++i)
    request[static_cast<int>(i) + 1] = arguments[i];
  return ros::master::execute(method, request, response, payload, false);
}

int publishers(const std::string& uri) {
  int count = 0;
  std::vector<std::string> names;
  ros::TopicManager::instance()->getAdvertisedTopics(names);
  for (const std::string& topic : names)
    if (const auto publication = ros::TopicManager::instance()->lookupPublication(topic))
      count += tell("registerPublisher", {topic, publication->getDataType(), uri}) ? 1 : 0;
  return count;
}

int subscribers(const std::string& uri) {
  int count = 0;
  std::vector<std::string> names;
  ros::TopicManager::instance()->getSubscribedTopics(names);
  for (const std::string& topic : names)
    count += tell("registerSubscriber", {topic, "*", uri}) ? 1 : 0;
  return count;
}

/// roscpp tells nobody which services a node has: all names that a node of ours may have are tried.
int services(const std::string& uri, const std::string& space) {
  const std::string address = "rosrpc://" + ros::network::getHost() + ":" +
                              std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  int count = 0;
  for (const char* name :
       {topics::kPause, topics::kStep, topics::kReset, topics::kManual, topics::kAdapt,
        topics::kManualInput, topics::kHold, "set_parameters", "get_loggers", "set_logger_level"}) {
    const std::string service = space + "/" + name;
    if (ros::ServiceManager::instance()->lookupServicePublication(service))
      count += tell("registerService", {service, address, uri}) ? 1 : 0;
  }
  return count;
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

int registerAgain(const std::vector<std::string>& spaces) {
  const std::string uri = ros::XMLRPCManager::instance()->getServerURI();
  int count = publishers(uri) + subscribers(uri);
  for (const std::string& space : spaces) count += services(uri, space);
  return count;
}

}  // namespace fpc
