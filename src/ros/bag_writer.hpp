// Every topic of the loop in a bag, written by the recorder itself: the plant waits for it, so that
// nothing is lost at any pace.
#pragma once

#include <ros/ros.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <map>
#include <string>

namespace fpc {

/// Topics in the node's namespace. The file is FILE.active until it is closed. What FILE holds is
/// joined if it is of the same run, else it goes to the folder's history.
class BagWriter {
 public:
  /// Begins with `loop_text` on the topic of that name, for `fmbpc replay`.
  BagWriter(ros::NodeHandle node, std::string file, std::string loop_text);
  /// Listens to topics that are new. True once all that are published are connected and no other
  /// one has come for a while. To be called every 0.1 s or so.
  bool look();
  /// `goes_on`: the run began in an earlier process.
  void close(bool goes_on);
  /// Why the bag is not whole, in words; empty if it is.
  const std::string& problem() const { return problem_; }

 private:
  using Message = topic_tools::ShapeShifter;
  void listen(const std::string& topic);
  void write(const std::string& topic, const ros::MessageEvent<const Message>& event);
  void join();
  template <typename Action>
  void guarded(Action action);

  ros::NodeHandle node_;
  std::string file_, active_, loop_text_, problem_;
  rosbag::Bag bag_;
  std::map<std::string, ros::Subscriber> topics_;
  int quiet_{};  // looks without a new topic
};

}  // namespace fpc
