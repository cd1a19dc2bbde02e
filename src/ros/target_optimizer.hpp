// The target layer over topics: a measurement in, the targets of the same sample out, which the
// controller waits for.
#pragma once

#include <fmbpc/FuzzyModel.h>
#include <fmbpc/Identified.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/Setpoint.h>
#include <fmbpc/Targets.h>
#include <ros/ros.h>

#include <optional>
#include <string>

#include "config/loop_file.hpp"
#include "ros/exchange_publisher.hpp"
#include "ros/health_reporter.hpp"
#include "ros/listener_gate.hpp"
#include "ros/node.hpp"
#include "ros/plant_gate.hpp"
#include "ros/ready.hpp"
#include "ros/signal_publishers.hpp"
#include "ros/summary_listener.hpp"
#include "runtime/first_answers.hpp"
#include "runtime/model_inbox.hpp"
#include "runtime/target_session.hpp"

namespace fpc {

/// Ready when a fitting plant has introduced itself, a fitting model has come and everybody who
/// listens is connected. signals():
/// NAME_target of each output and input, targets_cost, targets_moved (samples of this run at which
/// a target of an input moved), targets_travel.
class TargetOptimizer : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  TargetOptimizer(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);

 private:
  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onModel(const fmbpc::FuzzyModel::ConstPtr& msg);
  void onIdentified(const fmbpc::Identified::ConstPtr& msg);
  void onMeasurement(const fmbpc::Measurement::ConstPtr& msg);
  void onSetpoint(const fmbpc::Setpoint::ConstPtr& msg);
  void useModels(const StepHeader& next);
  bool mayAnswer(const Measurement& measurement);
  void answerParked();
  void publish(bool repeated);
  void report(Diagnostics::Status& status) const;
  Health health(double now_s) const;

  LoopFile loop_;
  TargetSession session_;
  ModelInbox inbox_;
  ReadyPublisher ready_;
  SignalPublishers signals_;
  PlantGate plant_;
  std::optional<Measurement> parked_;  // waits for a model, or for the run to be announced
  double heard_s_{};

  Comeback comeback_;
  ExchangePublisher<fmbpc::Targets> targets_;
  ListenerGate listeners_;
  ros::Subscriber plant_subscriber_, model_subscriber_, identified_subscriber_,
      measurement_subscriber_, setpoint_subscriber_;
  SteadyTimer parked_timer_;
  SummaryListener summary_;
  HealthReporter health_;
};

}  // namespace fpc
