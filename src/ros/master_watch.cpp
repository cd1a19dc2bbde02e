#include "ros/master_watch.hpp"

#include <pthread.h>
#include <ros/network.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "ros/neighbours.hpp"
#include "ros/registration.hpp"
#include "ros/topics.hpp"

namespace fpc {

/// What the master is to be told of a node, and whom the node must reach.
struct WatchedNode {
  KeptParameters parameters;
  std::string space;
  std::set<std::string> members, speakers;  // the latter with the plant
};

/// The thread of a process, for all its nodes.
class MasterEye {
 public:
  static std::shared_ptr<MasterEye> ofProcess();
  MasterEye() : thread_([this] { run(); }) {
    pthread_setname_np(thread_.native_handle(), "master_watch");
  }
  ~MasterEye();
  void add(std::shared_ptr<const WatchedNode> node);
  void remove(const std::shared_ptr<const WatchedNode>& node);

 private:
  using Nodes = std::vector<std::shared_ptr<const WatchedNode>>;
  void run();
  void look(const Nodes& nodes);
  void lookAtLinks(const Nodes& nodes, NodeAddresses& addresses);

  bool master_gone_{false};
  bool stop_{false};
  Links links_;
  const Starter starter_;
  Nodes nodes_;
  std::set<std::string> reached_;  // addresses of members that have answered
  std::mutex mutex_;               // of nodes_ and stop_
  std::condition_variable wake_;
  std::thread thread_;
};

namespace {

constexpr std::chrono::milliseconds kPeriod{2000}, kQuick{500};  // the latter: while one is silent

std::mutex problem_mutex;
NetworkProblem problem;

void log(const std::string& words, const std::string& before) {
  if (!words.empty() && words != before)
    ROS_ERROR("%s: %s", ros::this_node::getName().c_str(), words.c_str());
}

void say(const NetworkProblem& now) {
  const std::lock_guard<std::mutex> lock(problem_mutex);
  log(now.here, problem.here);
  log(now.there, problem.there);
  problem = now;
}

}  // namespace

NetworkProblem networkProblem() {
  const std::lock_guard<std::mutex> lock(problem_mutex);
  return problem;
}

std::shared_ptr<MasterEye> MasterEye::ofProcess() {
  static std::mutex mutex;
  static std::weak_ptr<MasterEye> present;
  const std::lock_guard<std::mutex> lock(mutex);
  std::shared_ptr<MasterEye> eye = present.lock();
  if (!eye) present = eye = std::make_shared<MasterEye>();
  return eye;
}

MasterEye::~MasterEye() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void MasterEye::add(std::shared_ptr<const WatchedNode> node) {
  const std::lock_guard<std::mutex> lock(mutex_);
  nodes_.push_back(std::move(node));
}

void MasterEye::remove(const std::shared_ptr<const WatchedNode>& node) {
  const std::lock_guard<std::mutex> lock(mutex_);
  nodes_.erase(std::remove(nodes_.begin(), nodes_.end(), node), nodes_.end());
}

void MasterEye::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto period = [this] {
    return networkProblem().there.empty() && !links_.suspicious() ? kPeriod : kQuick;
  };
  while (!wake_.wait_for(lock, period(), [this] { return stop_; })) {
    const Nodes nodes = nodes_;
    lock.unlock();
    if (ros::ok() && !nodes.empty()) look(nodes);
    lock.lock();
  }
}

void MasterEye::look(const Nodes& nodes) {
  NodeAddresses addresses;
  NetworkProblem now;
  now.here = descriptorProblem();
  if (now.here.empty())
    now.here = ownAddressProblem(ros::network::getHost(), ros::master::getHost());
  if (now.here.empty()) {
    lookAtLinks(nodes, addresses);
    std::set<std::string> members, speakers;
    for (const auto& node : nodes) {
      members.insert(node->members.begin(), node->members.end());
      speakers.insert(node->speakers.begin(), node->speakers.end());
    }
    if (!master_gone_) now.there = unreachable(members, addresses, reached_);
    const std::string missing = links_.missing(speakers);
    if (now.there.empty() && !missing.empty()) now.there = "not connected: " + missing;
    now.here = starter_.problem();
  }
  say(now);
}

void MasterEye::lookAtLinks(const Nodes& nodes, NodeAddresses& addresses) {
  const std::string& name = ros::this_node::getName();
  std::vector<std::string> spaces;
  for (const auto& node : nodes) spaces.push_back(node->space);
  const Links::Master master = links_.look(spaces, addresses);
  if (!ros::ok() || ros::isShuttingDown()) return;
  if (master == Links::Master::kSilent && !master_gone_)
    ROS_ERROR("%s: the master does not answer: the loop goes on, but nobody can join it",
              name.c_str());
  master_gone_ = master == Links::Master::kSilent;
  if (master != Links::Master::kForgot) return;
  bool lost = false;
  for (const auto& node : nodes) lost = node->parameters.putBack() || lost;
  ROS_WARN("%s: the master did not have its topics and services any more: registered again%s",
           name.c_str(), lost ? ", parameters put back" : "");
}

MasterWatch::MasterWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const LoopFile& loop)
    : eye_(MasterEye::ofProcess()) {
  std::set<std::string> members;
  for (const std::string& name : loop.exchange.members) members.insert(node.resolveName(name));
  std::set<std::string> speakers = members;
  for (const std::string& name : loop.exchange.publishers.at(topics::kPlantInfo))
    speakers.insert(node.resolveName(name));
  node_ = std::make_shared<const WatchedNode>(WatchedNode{KeptParameters(private_node),
                                                          private_node.getNamespace(),
                                                          std::move(members), std::move(speakers)});
  eye_->add(node_);
}

MasterWatch::~MasterWatch() { eye_->remove(node_); }

}  // namespace fpc
