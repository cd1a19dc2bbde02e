// Who must be ready before sample 0, and how a node says that it is.
#pragma once

#include <fmbpc/NodeReady.h>
#include <ros/ros.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "ros/node.hpp"
#include "ros/steady_timer.hpp"

namespace fpc {

/// Says "ready", once, latched, as soon as its node is.
class ReadyPublisher : public Node {
 public:
  /// `name`: of the node; `ready`: asked again and again until it is.
  ReadyPublisher(ros::NodeHandle node, const LoopFile& loop, std::string name,
                 std::function<bool()> ready);
  bool announced() const { return announced_; }

 private:
  void announce();

  std::function<bool()> is_ready_;
  std::string loop_digest_;
  ros::Publisher publisher_;
  bool announced_{false};
  SteadyTimer timer_;
};

/// Listens for the nodes named (relative to the namespace of `node`); each speaks for itself. Who
/// reads another loop_text than this node is not ready.
class ReadyListener : public Node {
 public:
  /// `name`: of the node that listens.
  ReadyListener(ros::NodeHandle node, const LoopFile& loop, std::string name,
                const std::vector<std::string>& names);
  std::vector<std::string> missing() const;
  /// In one line, with who of them reads another loop_text; if nobody is missing, what is left to
  /// wait for.
  std::string named(const std::vector<std::string>& missing) const;
  using Node::authority;

 private:
  void onReady(const fmbpc::NodeReady::ConstPtr& msg, const std::string& publisher);

  std::string loop_digest_;
  std::set<std::string> missing_, strangers_;
  ros::Subscriber subscriber_;
};

}  // namespace fpc
