// What a node has registered with the master, for a master that was started anew and knows nothing.
#pragma once

#include <ros/ros.h>

#include <map>
#include <string>
#include <vector>

namespace fpc {

/// Private parameters and the loop, as they were at the start of the node.
class KeptParameters {
 public:
  explicit KeptParameters(const ros::NodeHandle& private_node);
  /// Puts back what the master no longer has; true if there was something.
  bool putBack() const;

 private:
  void keep(const std::string& name, XmlRpc::XmlRpcValue& value);

  std::map<std::string, XmlRpc::XmlRpcValue> values_;  // by full name
};

/// Registers all topics of this process, and the services in the name spaces of its nodes, once
/// more. Connections that live are not touched.
/// @return how many.
int registerAgain(const std::vector<std::string>& spaces);

}  // namespace fpc
