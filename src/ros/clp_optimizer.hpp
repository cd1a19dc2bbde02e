// The closed-loop-paradigm optimizer over topics: base and predictive action of a sample in,
// control action out.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/InputPlan.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/PredictiveAction.h>
#include <fmbpc/SolverReport.h>
#include <ros/ros.h>

#include <cstdint>
#include <string>

#include "config/loop_file.hpp"
#include "ros/exchange_publisher.hpp"
#include "ros/health_reporter.hpp"
#include "ros/hearers.hpp"
#include "ros/listener_gate.hpp"
#include "ros/node.hpp"
#include "ros/plant_gate.hpp"
#include "ros/ready.hpp"
#include "ros/signal_publishers.hpp"
#include "ros/summary_listener.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/first_answers.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// Ready when a fitting plant has introduced itself and everybody who listens is connected.
class ClpOptimizer : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  ClpOptimizer(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);

 private:
  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onBase(const fmbpc::ControlAction::ConstPtr& msg);
  void onPrediction(const fmbpc::PredictiveAction::ConstPtr& msg);
  template <typename Item>
  void receive(const Item& item);
  void publish();
  void publishPlan();
  void report(Diagnostics::Status& status) const;
  Health health(double now_s) const;

  OptimizerSession session_;
  ReadyPublisher ready_;
  SignalPublishers signals_;
  PlantGate plant_;
  StepHeader last_;  // of the last answer that was not a repetition
  WallThrottle log_{1.0};

  Comeback comeback_;
  ExchangePublisher<fmbpc::ControlAction> action_;
  ExchangePublisher<fmbpc::SolverReport> report_;
  ros::Publisher plan_;
  Hearers plan_hearers_;
  ListenerGate listeners_;
  ros::Subscriber plant_subscriber_, base_subscriber_, prediction_subscriber_;
  SummaryListener summary_;
  Pace pace_;
  double period_s_, heard_s_{};
  std::string controller_;
  HealthReporter health_;
};

}  // namespace fpc
