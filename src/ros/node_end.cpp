#include "ros/node_end.hpp"

#include <ros/ros.h>

#include <utility>

namespace fpc {
namespace {

thread_local std::function<void(const std::string& why)> end_of_nodes_here;

}  // namespace

void onNodeEnd(std::function<void(const std::string& why)> hook) {
  end_of_nodes_here = std::move(hook);
}

void endNode(const std::string& why) {
  if (!end_of_nodes_here) return ros::shutdown();
  const auto hook = end_of_nodes_here;  // it may be replaced meanwhile
  hook(why);
}

}  // namespace fpc
