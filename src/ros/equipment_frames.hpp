// The plant's equipment as tf frames, and sample lines whose delay is their length in the tf tree
// over a velocity.
#pragma once

#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/loop_file.hpp"

namespace fpc {

/// Broadcasts the frames of a loop file as static transforms, once, on the tree of `node`: that of
/// its loop, where its names are remapped.
class EquipmentFrames {
 public:
  /// Does nothing if the frames come from elsewhere (tf.broadcast false).
  void broadcast(ros::NodeHandle node, const TfParams& params, std::int64_t time_ns);

 private:
  ros::Publisher publisher_;
};

/// Looks up the lengths of sample lines; without lines it listens to nothing.
class SampleLines {
 public:
  SampleLines(const ros::NodeHandle& node, std::vector<SampleLine> lines);
  /// Tries the lines not yet found, without waiting. Returns (output, delay [s]) of those found
  /// now.
  std::vector<std::pair<std::string, double>> poll();
  /// Lines not yet found, "from -> to".
  std::vector<std::string> missing() const;

 private:
  std::vector<SampleLine> lines_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
};

}  // namespace fpc
