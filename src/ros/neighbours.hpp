// Can this node be reached by others, and can it reach them? A wrong ROS_IP is found at both ends:
// by the node that has it, and by those who look for that node.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <map>
#include <set>
#include <string>

namespace fpc {

/// IPv4 address of a host by its name, in digits; empty: nobody knows one.
std::string addressOf(const std::string& host);

/// One call of the XMLRPC interface at "http://host:port/", given up after a while or once this
/// process ends: who hangs there hangs nobody here. False: no answer, or one that is none.
bool ask(const std::string& uri, const std::string& method, const XmlRpc::XmlRpcValue& arguments,
         XmlRpc::XmlRpcValue& payload, double patience_s = 3.0);

/// What is wrong with the name or address that this node gives to others, in words; empty: nothing.
/// `master_host` as in ROS_MASTER_URI.
std::string ownAddressProblem(const std::string& own_host, const std::string& master_host);

/// Who started this process: a roslaunch that was killed cannot start it again, nor end it.
class Starter {
 public:
  Starter();
  /// In words; empty: it lives, or was no roslaunch.
  std::string problem() const;

 private:
  int process_;  // 0: no roslaunch
};

/// What keeps this process from opening a connection at all, in words; empty: nothing.
std::string descriptorProblem();

/// Under which address the master knows a node, asked once for each.
class NodeAddresses {
 public:
  /// Empty: the master does not know it.
  const std::string& of(const std::string& node);

 private:
  std::map<std::string, std::string> known_;
};

/// Which of the nodes are known to the master by an address that nobody answers at, in words; empty
/// if there is none. A node that the master does not know is none. `reached`: addresses that have
/// answered, which are therefore not wrong; it is added to.
std::string unreachable(const std::set<std::string>& nodes, NodeAddresses& addresses,
                        std::set<std::string>& reached);

/// "http://host:port/" -> true if somebody accepts connections there within the time.
bool answersAt(const std::string& uri, double patience_s);

}  // namespace fpc
