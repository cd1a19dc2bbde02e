// The node fuzzy_optimal_controller: a controller whose weights and horizons a person may change
// while it runs.
#pragma once

#include <dynamic_reconfigure/server.h>
#include <fmbpc/FuzzyOptimalConfig.h>

#include <string>

#include "fmbpc/ros/controller_node.hpp"

namespace fpc {

/// Serves dynamic_reconfigure under its own name. It starts with the settings of the loop file,
/// whatever the parameter server holds; a change acts from the next sample on, and one that the law
/// refuses is logged and taken back.
class FuzzyOptimalControllerNode : public ControllerNode {
 public:
  static std::string idleReason(const LoopFile& loop);
  FuzzyOptimalControllerNode(ros::NodeHandle node, ros::NodeHandle private_node,
                             const LoopFile& loop);

 private:
  void onReconfigure(fmbpc::FuzzyOptimalConfig& config);

  bool started_{false};
  dynamic_reconfigure::Server<fmbpc::FuzzyOptimalConfig> server_;
};

}  // namespace fpc
