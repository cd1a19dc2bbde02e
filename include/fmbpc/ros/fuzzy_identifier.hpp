// Owner of the fuzzy_model topic: obtains the model that the loop names, checks it against the
// plant, publishes it.
#pragma once

#include <fmbpc/PlantInfo.h>
#include <ros/ros.h>

#include <string>
#include <vector>

#include "fmbpc/fuzzy/ts_model.hpp"
#include "fmbpc/loop/loop_file.hpp"
#include "fmbpc/ros/diagnostics.hpp"
#include "fmbpc/ros/node.hpp"
#include "fmbpc/ros/ready.hpp"

namespace fpc {

/// Ready when a model that fits the plant is published.
class FuzzyIdentifier : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  FuzzyIdentifier(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);

 private:
  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  /// The only source of models so far is the file that the loop names.
  const TsModel& obtain() const { return loop_.model; }
  void offer(const TsModel& model);
  void report(Diagnostics::Status& status) const;

  LoopFile loop_;
  ReadyPublisher ready_;
  std::string problem_;
  std::vector<RuleRemark> remarks_;
  bool published_{false};

  ros::Publisher model_;
  ros::Subscriber plant_subscriber_;
  Diagnostics diagnostics_;
};

}  // namespace fpc
