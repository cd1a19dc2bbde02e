// Holds back the first answer of a node that joins a running loop, and the first sample of a plant,
// until everybody who listens is connected: otherwise a recorder, ready long before a plant came
// back, would miss samples that have been used already.
#pragma once

#include <ros/ros.h>

#include <vector>

namespace fpc {

/// Open as soon as each publisher has as many connections as the master knows listeners, and each
/// subscriber as many as it knows publishers; one that died without a word holds it back for a
/// second of wall time only. Once open it stays open.
class ListenerGate {
 public:
  explicit ListenerGate(std::vector<ros::Publisher> publishers)
      : publishers_(std::move(publishers)) {}
  /// An answer to the first answer would be lost before this is connected.
  void alsoHear(const ros::Subscriber& subscriber) { subscribers_.push_back(subscriber); }
  bool open();

 private:
  bool allConnected() const;

  std::vector<ros::Publisher> publishers_;
  std::vector<ros::Subscriber> subscribers_;
  double deadline_s_{-1};
  bool open_{false};
};

}  // namespace fpc
