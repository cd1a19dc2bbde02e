#include "ros/master_watch.hpp"

#include <ros/network.h>

#include <chrono>

#include "ros/neighbours.hpp"

namespace fpc {
namespace {

constexpr std::chrono::seconds kPeriod{2};

std::mutex problem_mutex;
std::string problem;

void say(const std::string& words) {
  const std::lock_guard<std::mutex> lock(problem_mutex);
  if (words == problem) return;
  problem = words;
  if (!words.empty()) ROS_ERROR("%s: %s", ros::this_node::getName().c_str(), words.c_str());
}

bool ask(const char* method, const std::string& argument) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!argument.empty()) request[1] = argument;
  return ros::master::execute(method, request, response, payload, false);
}

}  // namespace

std::string networkProblem() {
  const std::lock_guard<std::mutex> lock(problem_mutex);
  return problem;
}

MasterWatch::MasterWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const LoopFile& loop)
    : parameters_(private_node), space_(private_node.getNamespace()), members_(loop.ring.members) {
  for (std::string& name : members_) name = node.resolveName(name);
  thread_ = std::thread([this] { run(); });
}

MasterWatch::~MasterWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void MasterWatch::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!wake_.wait_for(lock, kPeriod, [this] { return stop_; })) {
    lock.unlock();
    if (ros::ok()) look();
    lock.lock();
  }
}

void MasterWatch::look() {
  lookAtMaster();
  std::string words = ownAddressProblem(ros::network::getHost(), ros::master::getHost());
  if (words.empty() && !master_gone_) words = unreachable(members_);
  say(words);
}

void MasterWatch::lookAtMaster() {
  const std::string& name = ros::this_node::getName();
  if (ask("lookupNode", name)) {
    master_gone_ = false;
    return;
  }
  const bool answers = ask("getPid", "");
  if (!ros::ok() || ros::isShuttingDown()) return;
  if (!answers) {
    if (!master_gone_)
      ROS_ERROR("%s: the master does not answer: the loop goes on, but nobody can join it",
                name.c_str());
    master_gone_ = true;
    return;
  }
  master_gone_ = false;
  const bool lost = parameters_.putBack();
  const int count = registerAgain(space_);
  ROS_WARN("%s: the master was started anew: %d topics and services registered again%s",
           name.c_str(), count, lost ? ", parameters put back" : "");
}

}  // namespace fpc
