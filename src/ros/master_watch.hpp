// An eye on the master and the network, in a thread of its own, since a master that hangs would
// hang whoever asks it.
#pragma once

#include <ros/ros.h>

#include <memory>
#include <string>

#include "config/loop_file.hpp"

namespace fpc {

class MasterEye;
struct WatchedNode;

/// As long as it lives: a master that was started anew is told again what this node publishes,
/// subscribes and serves, and gets its parameters back; a wrong ROS_IP here or at a member of the
/// loop is said (networkProblem()). Looked at every few seconds, once for all nodes of a process.
class MasterWatch {
 public:
  MasterWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const LoopFile& loop);
  ~MasterWatch();
  MasterWatch(const MasterWatch&) = delete;
  MasterWatch& operator=(const MasterWatch&) = delete;

 private:
  std::shared_ptr<MasterEye> eye_;  // of the process: the first one opens it, the last one shuts it
  std::shared_ptr<const WatchedNode> node_;
};

/// What is wrong with the network as this process sees it, in words; empty: nothing is known.
struct NetworkProblem {
  std::string here, there;  ///< with this node's own address; with another member
};
NetworkProblem networkProblem();

}  // namespace fpc
