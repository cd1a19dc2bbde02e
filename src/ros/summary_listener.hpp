// What the plant says of the whole loop, for members that cannot see its end or a pause themselves.
#pragma once

#include <fmbpc/LoopState.h>
#include <ros/ros.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "ros/node.hpp"
#include "ros/topics.hpp"
#include "runtime/health.hpp"

namespace fpc {

class SummaryListener : public Node {
 public:
  /// `name`: of the node that listens.
  SummaryListener(ros::NodeHandle node, const LoopFile& loop, std::string name)
      : Node(node, loop, std::move(name)),
        subscriber_(subscribe(node, topics::kLoopState, queueOf(ListenerKind::kPeer),
                              &SummaryListener::onState, this)) {}

  /// Why nothing is due: the run is finished or paused. Empty otherwise.
  std::optional<Health> rest() const {
    if (mode_ == LoopMode::kFinished)
      return Health{LoopMode::kFinished, EventCode::kNone, "finished", {}};
    // The event is the plant's: said by others too, it would come back to them in its summary.
    if (paused_) return Health{LoopMode::kHeld, EventCode::kNone, "the plant is paused", {}};
    return {};
  }

 private:
  void onState(const fmbpc::LoopState::ConstPtr& msg, const std::string& publisher) {
    if (!msg->summary || !isPlant(msg->node)) return;
    if (!speaksFor(topics::kLoopState, publisher, msg->node)) return;
    mode_ = static_cast<LoopMode>(msg->mode);
    paused_ = mode_ == LoopMode::kHeld && msg->code == kindOf(EventCode::kPaused).name;
  }

  bool isPlant(const std::string& node) const {
    const auto& plants = authority().publishersOf(topics::kMeasurement);
    return plants.empty() || std::find(plants.begin(), plants.end(), node) != plants.end();
  }

  LoopMode mode_{LoopMode::kStarting};
  bool paused_{false};
  ros::Subscriber subscriber_;
};

}  // namespace fpc
