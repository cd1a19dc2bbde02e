#include "ros/plant_gate.hpp"

#include <ros/ros.h>

#include "base/text_hash.hpp"
#include "fmbpc/base/input_error.hpp"
#include "ros/conversions.hpp"
#include "ros/plant_check.hpp"

namespace fpc {

PlantGate::PlantGate(const LoopFile& loop)
    : expected_(loop.plant_info), loop_digest_(textHash(loop.resolved)) {}

std::string PlantGate::mismatchOf(const PlantInfo& info, const std::string& loop_digest) const {
  const std::string mismatch = plantMismatch(expected_, info);
  if (!mismatch.empty() || loop_digest.empty() || loop_digest == loop_digest_) return mismatch;
  return "plant_info: the plant reads another loop_text than this node";
}

bool PlantGate::introduce(const fmbpc::PlantInfo& msg) {
  const PlantInfo info = fromMsg(msg);
  const std::string mismatch = mismatchOf(info, msg.loop_digest);
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
