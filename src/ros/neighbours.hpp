// Can this node be reached by others, and can it reach them? A wrong ROS_IP is found at both ends:
// by the node that has it, and by those who look for that node.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace fpc {

/// IPv4 address of a host by its name, in digits; empty: nobody knows one.
std::string addressOf(const std::string& host);

/// What is wrong with the name or address that this node gives to others, in words; empty: nothing.
/// `master_host` as in ROS_MASTER_URI.
std::string ownAddressProblem(const std::string& own_host, const std::string& master_host);

/// Which of the nodes are known to the master by an address that nobody answers at, in words; empty
/// if there is none. A node that the master does not know is none. `reached`: addresses that have
/// answered, which are therefore not wrong; it is added to.
std::string unreachable(const std::vector<std::string>& nodes, std::set<std::string>& reached);

/// "http://host:port/" -> true if somebody accepts connections there within the time.
bool answersAt(const std::string& uri, double patience_s);

}  // namespace fpc
