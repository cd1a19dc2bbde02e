#include "ros/neighbours.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/xmlrpc_manager.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcClient.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kConnectPatience = 1.0;  // [s] for a connection
constexpr rlim_t kSpareDescriptors = 16;  // connections of a node

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses resolve(const std::string& host, const std::string& port) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  const char* service = port.empty() ? nullptr : port.c_str();
  if (getaddrinfo(host.c_str(), service, &hints, &found) != 0) found = nullptr;
  return {found, &freeaddrinfo};
}

std::uint32_t numberOf(const sockaddr* address) {
  sockaddr_in in{};
  std::memcpy(&in, address, sizeof in);
  return ntohl(in.sin_addr.s_addr);
}

bool isLoopback(std::uint32_t number) { return number >> 24 == 127; }

bool isOurs(std::uint32_t number) {
  if (isLoopback(number)) return true;
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return true;  // nothing can be said
  bool ours = false;
  for (const ifaddrs* at = first; at != nullptr; at = at->ifa_next)
    if (at->ifa_addr != nullptr && at->ifa_addr->sa_family == AF_INET)
      ours = ours || numberOf(at->ifa_addr) == number;
  freeifaddrs(first);
  return ours;
}

bool connects(const addrinfo& to, double patience_s) {
  const int s = socket(to.ai_family, to.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (s < 0) return true;  // nothing can be said
  bool done = connect(s, to.ai_addr, to.ai_addrlen) == 0;
  if (!done && errno == EINPROGRESS) {
    pollfd wait{s, POLLOUT, 0};
    int error = 1;
    socklen_t size = sizeof error;
    done = poll(&wait, 1, static_cast<int>(1e3 * patience_s)) == 1 &&
           getsockopt(s, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
  }
  close(s);
  return done;
}

/// A call that says when nothing more will come of it.
class Call : public XmlRpc::XmlRpcClient {
 public:
  using XmlRpcClient::XmlRpcClient;
  unsigned handleEvent(unsigned event) override {
    const unsigned awaited = XmlRpcClient::handleEvent(event);
    over_ = awaited == 0;
    return awaited;
  }
  bool over() const { return over_; }

 private:
  bool over_{false};
};

}  // namespace

bool ask(const std::string& uri, const std::string& method, const XmlRpc::XmlRpcValue& arguments,
         XmlRpc::XmlRpcValue& payload, double patience_s) {
  constexpr double kTurn = 0.02;  // [s]
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return false;
  Call call(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue response;
  if (!call.executeNonBlock(method.c_str(), arguments)) return false;
  for (const double since_s = steadyNow(); !call.over(); call._disp.work(kTurn))
    if (ros::isShuttingDown() || steadyNow() - since_s > patience_s) return false;
  return call.executeCheckDone(response) &&
         ros::XMLRPCManager::instance()->validateXmlrpcResponse(method, response, payload);
}

std::string addressOf(const std::string& host) {
  const Addresses found = resolve(host, "");
  char text[INET_ADDRSTRLEN] = "";
  if (found) {
    const in_addr number{htonl(numberOf(found->ai_addr))};
    inet_ntop(AF_INET, &number, text, sizeof text);
  }
  return text;
}

std::string ownAddressProblem(const std::string& own_host, const std::string& master_host) {
  const Addresses own = resolve(own_host, ""), master = resolve(master_host, "");
  if (!own)
    return "this node calls itself " + own_host +
           ", which does not resolve here: set ROS_IP to this machine's address";
  const std::uint32_t mine = numberOf(own->ai_addr);
  if (!isOurs(mine))
    return "this node calls itself " + own_host +
           ", which is no address of this machine: ROS_IP or ROS_HOSTNAME is wrong here";
  if (master && isLoopback(mine) && !isOurs(numberOf(master->ai_addr)))
    return "this node calls itself " + own_host + ", but its master is on " + master_host +
           ": others look for it on their own machines; set ROS_IP to this machine's address "
           "(and unset ROS_HOSTNAME)";
  return "";
}

Starter::Starter() : process_(getppid()) {
  std::ifstream file("/proc/" + std::to_string(process_) + "/cmdline");
  const std::string command{std::istreambuf_iterator<char>(file), {}};
  if (command.find("roslaunch") == std::string::npos) process_ = 0;
}

std::string Starter::problem() const {
  if (process_ == 0 || process_ == getppid()) return "";
  return "the roslaunch that started this node was killed: nobody starts the node again or ends it";
}

// A node that starts again needs several: with one left its topics would not be connected.
std::string descriptorProblem() {
  std::error_code error;
  std::filesystem::directory_iterator all("/proc/self/fd", error);
  if (error) return "no connection can be made here: " + error.message();
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return "";
  rlim_t used = 0;
  for (const std::filesystem::directory_iterator end; all != end && !error; all.increment(error))
    if (std::stoull(all->path().filename().string()) < limit.rlim_cur) ++used;
  if (limit.rlim_cur >= used && limit.rlim_cur - used + 1 >= kSpareDescriptors) return "";
  return "no connection can be made here with a node that starts: fewer than " +
         std::to_string(kSpareDescriptors) + " file descriptors are left";
}

const std::string& NodeAddresses::of(const std::string& node) {
  const auto [at, is_new] = known_.emplace(node, "");
  if (!is_new) return at->second;
  XmlRpc::XmlRpcValue request, uri;
  request[0] = ros::this_node::getName();
  request[1] = node;
  if (ask(ros::master::getURI(), "lookupNode", request, uri) &&
      uri.getType() == XmlRpc::XmlRpcValue::TypeString)
    at->second = std::string(uri);
  return at->second;
}

bool answersAt(const std::string& uri, double patience_s) {
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return false;
  const Addresses to = resolve(host, std::to_string(port));
  return to && connects(*to, patience_s);
}

std::string unreachable(const std::set<std::string>& nodes, NodeAddresses& addresses,
                        std::set<std::string>& reached) {
  for (const std::string& node : nodes) {
    if (node == ros::this_node::getName()) continue;
    const std::string& uri = addresses.of(node);
    if (uri.empty()) continue;
    if (answersAt(uri, kConnectPatience)) {
      reached.insert(uri);
      continue;
    }
    const std::string who = node + " is registered at " + uri + ", where nobody answers";
    if (reached.count(uri) > 0) return who + " any more: it hangs, is dead, or the link is cut";
    return who + ": it is dead, its ROS_IP is wrong, or a firewall is between";
  }
  return "";
}

}  // namespace fpc
