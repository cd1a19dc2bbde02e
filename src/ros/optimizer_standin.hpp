// When the optimizer does not answer, the controller's base action, which keeps all limits, goes to
// the plant (see OptimizerWatch).
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/SolverReport.h>
#include <ros/ros.h>

#include <string>

#include "ros/exchange_publisher.hpp"
#include "ros/node.hpp"
#include "runtime/first_answers.hpp"
#include "runtime/optimizer_watch.hpp"
#include "runtime/session.hpp"

namespace fpc {

class OptimizerStandin : public Node {
 public:
  /// `name`, `comeback`: of the controller.
  OptimizerStandin(ros::NodeHandle node, const LoopFile& loop, std::string name,
                   const Comeback& comeback);
  /// A base action has been published for the optimizer. `repeated`: not for the first time.
  void asked(const ControllerAnswer& answer, bool repeated);
  const OptimizerWatch& watch() const { return watch_; }
  const std::string& optimizer() const { return optimizer_; }  ///< its full name
  const ros::Subscriber& hearing() const { return subscriber_; }

 private:
  void onAction(const fmbpc::ControlAction::ConstPtr& msg, const std::string& publisher);
  bool isOwn(const fmbpc::ControlAction& msg, const std::string& publisher);
  void send(bool repeated);
  void onTimer();
  void arm();
  void takeOver();

  OptimizerWatch watch_;
  std::string optimizer_;
  ControlAction base_;
  bool sent_{false};  // base_ went to the plant
  int unheard_{};     // times that it was sent and has not come back on the topic
  WallThrottle log_{1.0};
  ExchangePublisher<fmbpc::ControlAction> action_;
  ExchangePublisher<fmbpc::SolverReport> report_;
  ros::Subscriber subscriber_;
  SteadyTimer timer_;
};

}  // namespace fpc
