// Keeps what operators have asked of a controller, and the model it works with, beside the plant:
// a controller that comes back finds both, whether or not anybody else lives.
#pragma once

#include <fmbpc/FuzzyModel.h>
#include <fmbpc/OperatorState.h>
#include <ros/ros.h>

#include <string>

#include "ros/node.hpp"

namespace fpc {

class OperatorKeeper : public Node {
 public:
  /// `name`: of the plant.
  OperatorKeeper(ros::NodeHandle node, const LoopFile& loop, std::string name);
  void beginRun(std::uint64_t run_id);  ///< what was asked in the run before is forgotten

 private:
  void onState(const fmbpc::OperatorState::ConstPtr& msg);
  void onModel(const fmbpc::FuzzyModel::ConstPtr& msg);

  std::uint64_t run_id_{};
  ros::Publisher kept_, model_kept_;
  ros::Subscriber subscriber_, model_subscriber_;
};

}  // namespace fpc
