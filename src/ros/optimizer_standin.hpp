// When the optimizer does not answer, the controller's base action, which keeps all limits, goes to
// the plant (see OptimizerWatch).
#pragma once

#include <fmbpc/ControlAction.h>
#include <ros/ros.h>

#include <string>

#include "fmbpc/control/session.hpp"
#include "fmbpc/loop/optimizer_watch.hpp"
#include "ros/node.hpp"

namespace fpc {

class OptimizerStandin : public Node {
 public:
  OptimizerStandin(ros::NodeHandle node, const LoopFile& loop);
  /// A base action has been published for the optimizer. `repeated`: not for the first time.
  void asked(const ControllerAnswer& answer, bool repeated);
  const OptimizerWatch& watch() const { return watch_; }
  const std::string& optimizer() const { return optimizer_; }  ///< its full name

 private:
  void onAction(const fmbpc::ControlAction::ConstPtr& msg);
  void onTimer();
  void arm();
  void takeOver();

  OptimizerWatch watch_;
  std::string optimizer_;
  ControlAction base_;
  bool sent_{false};  // base_ went to the plant
  WallThrottle log_{1.0};
  ros::Publisher action_, report_;
  ros::Subscriber subscriber_;
  ros::SteadyTimer timer_;
};

}  // namespace fpc
