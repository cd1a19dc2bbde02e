// Owner of the fuzzy_model topic: publishes the model that the loop names, and better ones that it
// finds while the plant runs: on request (an action), by itself after a number of samples, or
// sample by sample (online).
#pragma once

#include <actionlib/server/action_server.h>
#include <fmbpc/FuzzyModel.h>
#include <fmbpc/IdentifyModelAction.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <ros/ros.h>

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "ros/health_reporter.hpp"
#include "ros/identification_worker.hpp"
#include "ros/node.hpp"
#include "ros/plant_gate.hpp"
#include "ros/ready.hpp"
#include "runtime/identifier_duty.hpp"
#include "runtime/identifier_session.hpp"

namespace fpc {

/// Ready when the loop's model, if it names one, fits the plant and is published and, with
/// model.identify, measurements can come. Action ~identify (IdentifyModel), one goal at a time;
/// another one is rejected. Identification runs in a thread of its own, everything else in the
/// node's callbacks; in lockstep the word that a sample is done (`identified`) waits for it. One
/// that comes back publishes the model that the plant kept. Parameter ~out: folder where each
/// published identified model is written as model.yaml.
class FuzzyIdentifier : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  FuzzyIdentifier(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);

 private:
  using Server = actionlib::ActionServer<fmbpc::IdentifyModelAction>;

  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onModelKept(const fmbpc::FuzzyModel::ConstPtr& msg);
  void onMeasurement(const fmbpc::Measurement::ConstPtr& msg);
  void onGoal(Server::GoalHandle goal);
  void onCancel(Server::GoalHandle goal);
  void poll();
  void publishStartModel();
  bool isReady() const;
  void begin(IdentificationJob job, bool publish);
  void finishJob(const IdentificationWorker::Outcome& outcome);
  void conclude(const IdentificationWorker::Outcome& outcome, fmbpc::IdentifyModelResult& result);
  void publish(const TsModel& matched, const StepHeader& made_from);
  void say(const IdentifierDuty::Words& words);
  void write(const TsModel& model) const;
  void hadNoModel(EventCode code, const std::string& why, const StepHeader& made_from);
  void say(const Notice& notice, const StepHeader& of);
  Health health(double now_s) const;
  void report(Diagnostics::Status& status) const;

  LoopFile loop_;
  std::string out_;
  ReadyPublisher ready_;
  PlantGate plant_;
  IdentifierSession session_;
  IdentifierDuty duty_;
  std::vector<fmbpc::Measurement::ConstPtr>
      unannounced_;  // of runs that plant_info has not announced yet
  std::string problem_, last_identification_{"none"};
  std::string failure_;  // of the latest model that was to be had
  double failed_s_{};
  EventCode failure_code_{EventCode::kNone};

  IdentificationWorker worker_;
  Server::GoalHandle goal_;  // of the job at work, if a client asked for it
  bool has_goal_{false}, publish_{false};
  std::string progress_;

  ros::Publisher model_publisher_, identified_;
  ros::Subscriber plant_subscriber_, kept_subscriber_, measurement_subscriber_;
  Server server_;
  SteadyTimer poll_timer_;
  HealthReporter health_;
};

}  // namespace fpc
