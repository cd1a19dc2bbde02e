// What a node hears of the loops beside its own: the parameter `loop_links`, searched upwards, says
// of which signals.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PredictiveAction.h>
#include <ros/ros.h>

#include <functional>
#include <string>
#include <vector>

#include "runtime/link_inbox.hpp"

namespace fpc {

class LinkListener {
 public:
  /// `heard`: called after each message. @throws InputError for a parameter that is none.
  LinkListener(const ros::NodeHandle& node, const ros::NodeHandle& private_node, Pace pace,
               LinkInbox::Of of, std::function<void()> heard);
  LinkInbox& inbox() { return inbox_; }
  const LinkInbox& inbox() const { return inbox_; }
  /// Topics of other loops that nobody publishes yet.
  std::vector<std::string> missing() const;

 private:
  void listen(ros::NodeHandle node, const std::string& from, LoopLink::Of of);
  /// read: the values of a message, for LinkInbox::hear().
  template <class Message, class Read>
  void hear(ros::NodeHandle& node, const std::string& from, LoopLink::Of of, const char* topic,
            Read read);

  LinkInbox inbox_;
  std::function<void()> heard_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace fpc
