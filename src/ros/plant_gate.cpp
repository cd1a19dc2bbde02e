#include "ros/plant_gate.hpp"

#include <ros/ros.h>

#include "fmbpc/base/input_error.hpp"
#include "ros/plant_check.hpp"

namespace fpc {

bool PlantGate::introduce(const PlantInfo& info) {
  const std::string mismatch = plantMismatch(expected_, info);
  if (open_) require(mismatch.empty(), mismatch, "the plant of this run");
  problem_ = mismatch;
  remark_ = mismatch.empty() ? boundsDifference(expected_, info) : "";
  if (!remark_.empty()) ROS_WARN("%s: %s", ros::this_node::getName().c_str(), remark_.c_str());
  open_ = problem_.empty();
  if (open_)
    run_id_ = info.header.run_id;
  else
    ROS_ERROR("%s: %s", ros::this_node::getName().c_str(), problem_.c_str());
  return open_;
}

bool PlantGate::admits(std::uint64_t run_id) {
  if (open_ && run_id == run_id_) return true;
  ++foreign_;
  return false;
}

}  // namespace fpc
