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

namespace fpc {

/// What the master is to be told of a node, and whom the node must reach.
struct WatchedNode {
  KeptParameters parameters;
  std::string space;
  std::vector<std::string> members;
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
  void lookAtMaster(const Nodes& nodes);

  bool master_gone_{false};
  bool stop_{false};
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

bool ask(const char* method, const std::string& argument) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!argument.empty()) request[1] = argument;
  return ros::master::execute(method, request, response, payload, false);
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
  while (!wake_.wait_for(lock, networkProblem().there.empty() ? kPeriod : kQuick,
                         [this] { return stop_; })) {
    const Nodes nodes = nodes_;
    lock.unlock();
    if (ros::ok() && !nodes.empty()) look(nodes);
    lock.lock();
  }
}

void MasterEye::look(const Nodes& nodes) {
  lookAtMaster(nodes);
  NetworkProblem now;
  now.here = ownAddressProblem(ros::network::getHost(), ros::master::getHost());
  if (now.here.empty() && !master_gone_) {
    std::set<std::string> members;
    for (const auto& node : nodes) members.insert(node->members.begin(), node->members.end());
    now.there = unreachable({members.begin(), members.end()}, reached_);
  }
  say(now);
}

void MasterEye::lookAtMaster(const Nodes& nodes) {
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
  bool lost = false;
  std::vector<std::string> spaces;
  for (const auto& node : nodes) {
    lost = node->parameters.putBack() || lost;
    spaces.push_back(node->space);
  }
  const int count = registerAgain(spaces);
  ROS_WARN("%s: the master was started anew: %d topics and services registered again%s",
           name.c_str(), count, lost ? ", parameters put back" : "");
}

MasterWatch::MasterWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const LoopFile& loop)
    : eye_(MasterEye::ofProcess()) {
  std::vector<std::string> members = loop.ring.members;
  for (std::string& name : members) name = node.resolveName(name);
  node_ = std::make_shared<const WatchedNode>(
      WatchedNode{KeptParameters(private_node), private_node.getNamespace(), std::move(members)});
  eye_->add(node_);
}

MasterWatch::~MasterWatch() { eye_->remove(node_); }

}  // namespace fpc
