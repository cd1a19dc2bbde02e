#include "ros/bag_writer.hpp"

#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/files.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "runtime/recover.hpp"

namespace fpc {
namespace {

namespace fs = std::filesystem;

constexpr int kQuiet = 5;  // looks

/// What a replay needs, whoever comes late.
constexpr const char* kAlways[] = {
    topics::kMeasurement,   topics::kBaseAction, topics::kControlAction, topics::kSetpointEffect,
    topics::kOperatorState, topics::kFuzzyModel, topics::kPlantInfo,     topics::kTracking};

/// A folder of its own in the history of the one where the file is.
void fileAway(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  const fs::path aside = freshAside(file.parent_path().string(), 0);
  fs::rename(file, aside / file.filename(), error);
  require(!error, file.string(), "a file that can be moved to " + aside.string());
  ROS_WARN("loop_recorder: %s of an earlier run is in %s now", file.filename().c_str(),
           aside.c_str());
}

void copy(const std::string& from, rosbag::Bag& to) {
  const rosbag::Bag bag(from, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& item : rosbag::View(bag))
    to.write(item.getTopic(), item.getTime(), item, item.getConnectionHeader());
}

}  // namespace

BagWriter::BagWriter(ros::NodeHandle node, std::string file, std::string loop_text)
    : node_(std::move(node)),
      file_(std::move(file)),
      active_(file_ + ".active"),
      loop_text_(std::move(loop_text)) {
  guarded([this] {
    makeFolder(fs::absolute(file_).parent_path());
    fileAway(active_);  // of a process that was killed: `rosbag reindex` makes it readable
    bag_.open(active_, rosbag::bagmode::Write);
  });
  for (const char* topic : kAlways) listen(node_.resolveName(topic));
}

/// A bag that a full disk has cut is not written any more.
template <typename Action>
void BagWriter::guarded(Action action) {
  if (!problem_.empty()) return;
  try {
    action();
  } catch (const std::exception& error) {
    problem_ = "the bag is not whole: " + active_ + ": " + error.what();
    ROS_ERROR("loop_recorder: %s", problem_.c_str());
  }
}

void BagWriter::listen(const std::string& topic) {
  const boost::function<void(const ros::MessageEvent<const Message>&)> handler =
      [this, topic](const ros::MessageEvent<const Message>& event) { write(topic, event); };
  topics_[topic] =
      node_.subscribe<Message>(topic, queueOf(ListenerKind::kRecord), handler, ros::VoidConstPtr(),
                               ros::TransportHints().tcpNoDelay());
}

void BagWriter::write(const std::string& topic, const ros::MessageEvent<const Message>& event) {
  guarded([&] {
    const ros::Time came = std::max(event.getReceiptTime(), ros::TIME_MIN);
    if (!loop_text_.empty()) {
      std_msgs::String text;
      text.data = std::exchange(loop_text_, "");
      bag_.write(node_.resolveName(topics::kLoopText), came, text);
    }
    bag_.write(topic, came, *event.getMessage(), event.getConnectionHeaderPtr());
  });
}

bool BagWriter::look() {
  ros::master::V_TopicInfo published;
  if (!ros::Time::isValid() || !ros::master::getTopics(published)) return false;
  const std::string space = node_.getNamespace() == "/" ? "/" : node_.getNamespace() + "/";
  bool settled = true;
  for (const ros::master::TopicInfo& topic : published) {
    if (topic.name.compare(0, space.size(), space) != 0) continue;
    const bool is_new = topics_.count(topic.name) == 0;
    if (is_new) listen(topic.name);
    settled = settled && !is_new && topics_[topic.name].getNumPublishers() > 0;
  }
  quiet_ = settled ? std::min(quiet_ + 1, kQuiet) : 0;
  return quiet_ == kQuiet;
}

// Both in a third file, which takes their place: whatever happens, nothing is lost.
void BagWriter::join() {
  const std::string joined = file_ + ".joined";
  {
    rosbag::Bag both(joined, rosbag::bagmode::Write);
    copy(file_, both);
    copy(active_, both);
  }
  fs::rename(joined, file_);
  fs::remove(active_);
}

void BagWriter::close(bool goes_on) {
  topics_.clear();
  if (!bag_.isOpen()) return;
  guarded([&] {
    bag_.close();
    if (goes_on && fs::exists(file_)) return join();
    fileAway(file_);
    fs::rename(active_, file_);
  });
}

}  // namespace fpc
