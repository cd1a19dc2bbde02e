// Every topic of the loop in a bag, written by the recorder itself: the plant waits for it, so that
// nothing is lost at any pace.
#pragma once

#include <ros/ros.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>

namespace fpc {

/// Topics in the node's namespace. The file is FILE.active until it is closed; what FILE holds of
/// the same run is joined then, what it holds of another goes to the folder's history. Times of
/// messages never go back: /clock is unknown to a recorder that has just come back.
class BagWriter {
 public:
  /// Begins with `loop_text` on the topic of that name, for `fmbpc replay`. `handed`: topics whose
  /// messages the caller takes; the bag listens to all others itself.
  BagWriter(ros::NodeHandle node, std::string file, std::string loop_text,
            const std::set<std::string>& handed);
  template <typename Msg>
  void take(const char* topic, const ros::MessageEvent<const Msg>& event) {
    put(node_.resolveName(topic), event);
  }
  /// The run whose messages come from now on.
  void begin(std::uint64_t run_id) { runs_.insert(run_id); }
  /// Listens to topics that are new. True once all that are published are connected and no other
  /// one has come for a while. To be called every 0.1 s or so.
  bool look();
  /// What came is on the disk itself, once a second at most; a process that is killed after that
  /// leaves it to `rosbag reindex`.
  void sync(double now_s);
  /// The part of an endless run ends here; the next one begins with the text and what is latched.
  void beginNextPart();
  void close();
  /// Why the bag is not whole, in words; empty if it is.
  const std::string& problem() const { return problem_; }

 private:
  using Message = topic_tools::ShapeShifter;
  void open();
  void writeText(ros::Time came);
  void listen(const std::string& topic);
  /// Also keeps what is latched, for the next part.
  template <typename Msg>
  void put(const std::string& topic, const ros::MessageEvent<const Msg>& event) {
    if (isLatched(event.getConnectionHeader()))
      latched_[topic + " " + event.getPublisherName()] = [=] { write(topic, event); };
    write(topic, event);
  }
  template <typename Msg>
  void write(const std::string& topic, const ros::MessageEvent<const Msg>& event) {
    guarded([&] {
      const ros::Time came = std::max(event.getReceiptTime(), ros::TIME_MIN);
      if (!has_text_) writeText(came);
      bag_.write(topic, came, *event.getMessage(), event.getConnectionHeaderPtr());
      unsynced_ = true;
    });
  }
  static bool isLatched(const ros::M_string& header);
  bool isOfTheseRuns(const std::string& file) const;
  void join();
  void finish();
  /// A bag that a full disk has cut is not written any more.
  template <typename Action>
  void guarded(Action action) {
    if (!problem_.empty()) return;
    try {
      action();
    } catch (const std::exception& error) {
      stop(error.what());
    }
  }
  void stop(const char* why);

  ros::NodeHandle node_;
  const std::string file_, active_, loop_text_;
  std::string problem_;
  std::set<std::uint64_t> runs_;  // that have begun here
  rosbag::Bag bag_;
  double synced_s_{-1e9};
  bool has_text_{false}, unsynced_{false};
  std::set<std::string> handed_;
  std::map<std::string, ros::Subscriber> topics_;
  std::map<std::string, std::function<void()>> latched_;  // the newest, by topic and publisher
  int quiet_{};                                           // looks without a new topic
};

}  // namespace fpc
