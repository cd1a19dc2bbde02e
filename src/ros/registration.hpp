// What a node has registered with the master and whom it is connected to, compared with what it
// should have, and mended.
#pragma once

#include <ros/ros.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "ros/neighbours.hpp"

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

/// The topics and services of this process and its connections. The master tells a node once who
/// publishes; what is lost then, or taken away by a stranger, nobody else makes again.
class Links {
 public:
  enum class Master { kAnswers, kSilent, kForgot };
  Links();  ///< of a node that has been started
  /// Compares what the master has of this process (services: in `spaces`, the names of its nodes)
  /// with what there is, and who publishes what it subscribes to with whom it is connected to. What
  /// lacks in two looks running is made again; a registration that the master has not had yet
  /// is on its way (roscpp makes it until it has worked), unless that takes long. `addresses`: of
  /// this look.
  /// @return kForgot: something was registered again.
  Master look(const std::vector<std::string>& spaces, NodeAddresses& addresses);
  /// Something lacked in the last look.
  bool suspicious() const { return !missing_.empty(); }
  /// "measurement of /plant_simulator" for connections to `members` that could not be made for two
  /// looks; empty: all are there.
  std::string missing(const std::set<std::string>& members) const;

 private:
  using Names = std::set<std::string>;
  using ByTopic = std::map<std::string, Names>;
  struct Missing {
    int looks;
    std::string node;  // the publisher that is not connected; empty: a registration
  };
  bool lacks(const std::string& what, const std::string& node = {});
  bool isForgotten(const std::string& what, bool known);
  void lookAtTopics(const ByTopic& publishers, const ByTopic& subscribers);
  bool serves(const std::string& service, bool listed);
  void lookAtServices(const ByTopic& services, const std::vector<std::string>& spaces);
  void lookAtPublishers(const ByTopic& publishers, NodeAddresses& addresses);

  const std::string services_at_;  // asked at the start: roscpp has no port any more when it ends
  std::map<std::string, Missing> missing_, before_;
  Names known_;       // registrations that the master has had
  int looks_{};       // at services
  int registered_{};  // in this look
};

}  // namespace fpc
