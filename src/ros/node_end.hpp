// How a node that cannot go on ends: its process with it, or in a host of many loops only its loop.
#pragma once

#include <functional>
#include <string>

namespace fpc {

/// For nodes whose callbacks run in the calling thread: called with the reason in the place of
/// ros::shutdown(). Empty: the process ends.
void onNodeEnd(std::function<void(const std::string& why)> hook);
void endNode(const std::string& why);

}  // namespace fpc
