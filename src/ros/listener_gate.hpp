// Holds back what a node says first until everybody who listens is connected: that it is ready, the
// first answer of one that joins a running loop, the first sample of a plant. Otherwise a recorder,
// ready long before a plant came back, would miss samples that have been used already, and an
// optimizer's first answer would come late.
#pragma once

#include <ros/ros.h>

#include <vector>

#include "runtime/own_wait.hpp"

namespace fpc {

/// Connected: each publisher has as many connections as the master knows listeners, and each
/// subscriber as many as it knows publishers. One that died without a word is waited for once, for
/// a second of wall time in which this process runs (OwnWait).
class ListenerGate {
 public:
  explicit ListenerGate(std::vector<ros::Publisher> publishers);
  /// An answer to the first answer would be lost before this is connected.
  void alsoHear(const ros::Subscriber& subscriber) { subscribers_.push_back(subscriber); }
  /// To be asked again and again until it is so; may be so no more a moment later.
  bool connected();
  /// Once open it stays open.
  bool open() { return open_ = open_ || connected(); }

 private:
  bool allConnected() const;

  std::vector<ros::Publisher> publishers_;
  std::vector<ros::Subscriber> subscribers_;
  OwnWait wait_;
  bool open_{false};
};

}  // namespace fpc
