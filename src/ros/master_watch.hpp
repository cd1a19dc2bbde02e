// An eye on the master and the network, in a thread of its own, since a master that hangs would
// hang whoever asks it.
#pragma once

#include <ros/ros.h>

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "ros/registration.hpp"

namespace fpc {

/// Every few seconds: a master that was started anew is told again what this node publishes,
/// subscribes and serves, and gets its parameters back; a wrong ROS_IP here or at a member of the
/// loop is said (networkProblem()).
class MasterWatch {
 public:
  MasterWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const LoopFile& loop);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

 private:
  void run();
  void look();
  void lookAtMaster();

  const KeptParameters parameters_;
  const std::string space_;  // of the node
  std::vector<std::string> members_;
  bool master_gone_{false};
  bool stop_{false};
  std::mutex mutex_;
  std::condition_variable wake_;
  std::thread thread_;
};

/// What is wrong with the network as this process sees it, in words; empty: nothing is known.
std::string networkProblem();

}  // namespace fpc
