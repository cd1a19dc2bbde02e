#include "ros/equipment_frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/conversions.hpp"

namespace fpc {
namespace {

geometry_msgs::TransformStamped transform(const EquipmentFrame& frame, const ros::Time& stamp) {
  geometry_msgs::TransformStamped msg;
  msg.header.stamp = stamp;
  msg.header.frame_id = frame.parent;
  msg.child_frame_id = frame.name;
  msg.transform.translation.x = frame.x;
  msg.transform.translation.y = frame.y;
  msg.transform.translation.z = frame.z;
  msg.transform.rotation.w = 1.0;
  return msg;
}

double length(const geometry_msgs::Vector3& v) {
  return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

}  // namespace

void EquipmentFrames::broadcast(ros::NodeHandle node, const TfParams& params,
                                std::int64_t time_ns) {
  if (!params.broadcast) return;
  tf2_msgs::TFMessage msg;
  for (const EquipmentFrame& frame : params.frames)
    if (!frame.parent.empty()) msg.transforms.push_back(transform(frame, toStamp(time_ns)));
  if (msg.transforms.empty()) return;
  publisher_ = node.advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  publisher_.publish(msg);
}

SampleLines::SampleLines(const ros::NodeHandle& node, std::vector<SampleLine> lines)
    : lines_(std::move(lines)) {
  if (lines_.empty()) return;
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_, node);
}

std::vector<std::pair<std::string, double>> SampleLines::poll() {
  std::vector<std::pair<std::string, double>> found;
  for (auto line = lines_.begin(); line != lines_.end();) {
    try {
      const auto step = buffer_->lookupTransform(line->from, line->to, ros::Time(0));
      found.emplace_back(line->output, length(step.transform.translation) / line->velocity_m_s);
      line = lines_.erase(line);
    } catch (const tf2::TransformException&) {
      ++line;  // not in the tree yet
    }
  }
  return found;
}

std::vector<std::string> SampleLines::missing() const {
  std::vector<std::string> names;
  for (const SampleLine& line : lines_) names.push_back("tf " + line.from + " -> " + line.to);
  return names;
}

}  // namespace fpc
