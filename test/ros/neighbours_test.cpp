// Whoever asks a node or the master gets an answer or gives up.
#include "ros/neighbours.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include "ros/wall_throttle.hpp"

namespace fpc {
namespace ros_neighbours_test {

/// A port of this machine to which connections are made that nobody ever takes.
class Silent {
 public:
  Silent() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(socket_, 4), 0);
    EXPECT_EQ(::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    uri_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
  }
  ~Silent() { shut(); }
  void shut() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  const std::string& uri() const { return uri_; }

 private:
  int socket_;
  std::string uri_;
};

TEST(Neighbours, OneThatNeverAnswersIsGivenUp) {
  Silent silent;
  XmlRpc::XmlRpcValue arguments, payload;
  arguments[0] = "/somebody";
  const double since_s = steadyNow();
  EXPECT_FALSE(ask(silent.uri(), "getPid", arguments, payload, 0.3));
  EXPECT_GE(steadyNow() - since_s, 0.3);
  silent.shut();  // refused: at once
  EXPECT_FALSE(ask(silent.uri(), "getPid", arguments, payload, 1e9));
  EXPECT_FALSE(ask("nonsense", "getPid", arguments, payload, 1e9));
}

TEST(Neighbours, FewFileDescriptorsThatAreLeftAreAProblem) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const int lowest_free = ::dup(0);
  ::close(lowest_free);
  const auto withLeft = [&](int left) {
    const rlimit now{static_cast<rlim_t>(lowest_free + left), before.rlim_max};
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &now), 0);
    const std::string problem = descriptorProblem();
    EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
    return problem;
  };
  EXPECT_FALSE(withLeft(0).empty());
  EXPECT_FALSE(withLeft(1).empty());
  EXPECT_TRUE(withLeft(100).empty());
}

}  // namespace ros_neighbours_test
}  // namespace fpc
