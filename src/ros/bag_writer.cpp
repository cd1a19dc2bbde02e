#include "ros/bag_writer.hpp"

#include <fmbpc/PlantInfo.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <cstdio>
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

/// What came while /clock was unknown came at `unknown`.
void copy(const std::string& from, rosbag::Bag& to, ros::Time unknown) {
  const rosbag::Bag bag(from, rosbag::bagmode::Read);
  for (const rosbag::MessageInstance& item : rosbag::View(bag))
    to.write(item.getTopic(), item.getTime() == ros::TIME_MIN ? unknown : item.getTime(), item,
             item.getConnectionHeader());
}

ros::Time endOf(const std::string& file) {
  const rosbag::Bag bag(file, rosbag::bagmode::Read);
  return rosbag::View(bag).getEndTime();
}

}  // namespace

BagWriter::BagWriter(ros::NodeHandle node, std::string file, std::string loop_text,
                     const std::set<std::string>& handed)
    : node_(std::move(node)),
      file_(std::move(file)),
      active_(file_ + ".active"),
      loop_text_(std::move(loop_text)) {
  guarded([this] {
    makeFolder(fs::absolute(file_).parent_path());
    fileAway(active_);  // of a process that was killed: `rosbag reindex` makes it readable
    open();
  });
  for (const std::string& topic : handed) handed_.insert(node_.resolveName(topic));
  for (const char* topic : kAlways)
    if (handed.count(topic) == 0) listen(node_.resolveName(topic));
}

void BagWriter::open() {
  bag_.open(active_, rosbag::bagmode::Write);
  has_text_ = false;
}

void BagWriter::writeText(ros::Time came) {
  std_msgs::String text;
  text.data = loop_text_;
  bag_.write(node_.resolveName(topics::kLoopText), came, text);
  has_text_ = true;
}

void BagWriter::stop(const char* why) {
  problem_ = "the bag is not whole: " + active_ + ": " + why;
  ROS_ERROR("loop_recorder: %s", problem_.c_str());
}

bool BagWriter::isLatched(const ros::M_string& header) {
  const auto latching = header.find("latching");
  return latching != header.end() && latching->second == "1";
}

void BagWriter::listen(const std::string& topic) {
  const boost::function<void(const ros::MessageEvent<const Message>&)> handler =
      [this, topic](const ros::MessageEvent<const Message>& event) { put(topic, event); };
  topics_[topic] =
      node_.subscribe<Message>(topic, queueOf(ListenerKind::kRecord), handler, ros::VoidConstPtr(),
                               ros::TransportHints().tcpNoDelay());
}

bool BagWriter::look() {
  ros::master::V_TopicInfo published;
  if (!ros::Time::isValid() || !ros::master::getTopics(published)) return false;
  const std::string space = node_.getNamespace() == "/" ? "/" : node_.getNamespace() + "/";
  bool settled = true;
  for (const ros::master::TopicInfo& topic : published) {
    if (topic.name.compare(0, space.size(), space) != 0 || handed_.count(topic.name) > 0) continue;
    const bool is_new = topics_.count(topic.name) == 0;
    if (is_new) listen(topic.name);
    settled = settled && !is_new && topics_[topic.name].getNumPublishers() > 0;
  }
  quiet_ = settled ? std::min(quiet_ + 1, kQuiet) : 0;
  return quiet_ == kQuiet;
}

void BagWriter::sync(double now_s) {
  if (!unsynced_ || now_s - synced_s_ < 1.0) return;
  guarded([this] {
    bag_.setChunkThreshold(bag_.getChunkThreshold());  // ends the chunk
    std::fflush(nullptr);                              // the library keeps its stream to itself
    syncFile(active_);
  });
  synced_s_ = now_s;
  unsynced_ = false;
}

bool BagWriter::isOfTheseRuns(const std::string& file) const {
  const rosbag::Bag bag(file, rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(node_.resolveName(topics::kPlantInfo)));
  return std::any_of(view.begin(), view.end(), [this](const rosbag::MessageInstance& item) {
    const auto info = item.instantiate<fmbpc::PlantInfo>();
    return info && runs_.count(info->run_id) > 0;
  });
}

// Both in a third file, which takes their place: whatever happens, nothing is lost.
void BagWriter::join() {
  const std::string joined = file_ + ".joined";
  {
    rosbag::Bag both(joined, rosbag::bagmode::Write);
    copy(file_, both, ros::TIME_MIN);
    copy(active_, both, endOf(file_));
  }
  fs::rename(joined, file_);
  fs::remove(active_);
}

void BagWriter::beginNextPart() {
  guarded([this] {
    finish();
    open();
    for (const auto& [name, write] : latched_) write();
  });
}

void BagWriter::close() {
  topics_.clear();
  guarded([this] { finish(); });
}

void BagWriter::finish() {
  if (!bag_.isOpen()) return;
  bag_.close();
  if (runs_.empty() && fs::exists(file_)) {  // nothing of a run has come
    fs::remove(active_);
  } else if (fs::exists(file_) && isOfTheseRuns(file_)) {
    join();
  } else {
    fileAway(file_);
    fs::rename(active_, file_);
  }
  syncFile(file_);
}

}  // namespace fpc
