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

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/fuzzy/online_learner.hpp"
#include "fmbpc/fuzzy/sample_collector.hpp"
#include "fmbpc/ros/diagnostics.hpp"
#include "fmbpc/ros/identification_worker.hpp"
#include "fmbpc/ros/node.hpp"
#include "fmbpc/ros/plant_gate.hpp"
#include "fmbpc/ros/ready.hpp"

namespace fpc {

/// Ready when the loop's model, if it names one, fits the plant and is published and, with
/// model.identify, measurements can come. Action ~identify (IdentifyModel), one goal at a time;
/// another one is rejected. Identification runs in a thread of its own, everything else in the
/// node's callbacks. Parameter ~out: folder where each published identified model is written as
/// model.yaml.
class FuzzyIdentifier : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  FuzzyIdentifier(ros::NodeHandle node, const ros::NodeHandle& private_node, const LoopFile& loop);

 private:
  using Server = actionlib::ActionServer<fmbpc::IdentifyModelAction>;

  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onMeasurement(const fmbpc::Measurement::ConstPtr& msg);
  void onGoal(Server::GoalHandle goal);
  void onCancel(Server::GoalHandle goal);
  void poll();
  void publishStartModel();
  void announceIfReady();
  void learn(const Measurement& measurement, Arrival arrival);
  void begin(Structure structure, std::size_t newest, double share, bool publish);
  void finishJob(const IdentificationWorker::Outcome& outcome);
  void conclude(const IdentificationWorker::Outcome& outcome, fmbpc::IdentifyModelResult& result);
  /// Publishes a model that fits the plant and is stable at the present sample. @throws InputError
  /// otherwise.
  void offer(const TsModel& model);
  void publish(const TsModel& matched);
  void write(const TsModel& model) const;
  void report(Diagnostics::Status& status) const;
  void reportWords(Diagnostics::Status& status) const;

  LoopFile loop_;
  std::string out_;
  ReadyPublisher ready_;
  PlantGate plant_;
  SampleCollector collector_;
  std::vector<fmbpc::Measurement::ConstPtr>
      unannounced_;  // of runs that plant_info has not announced yet
  std::optional<OnlineLearner> learner_;
  TsModel model_;  // published last, matched to the plant
  std::uint64_t published_{}, models_refused_{};
  std::string problem_, last_refusal_, last_identification_{"none"};
  std::vector<RuleRemark> remarks_;

  IdentificationWorker worker_;
  Server::GoalHandle goal_;  // of the job at work, if a client asked for it
  bool has_goal_{false}, publish_{false}, done_by_itself_{false};
  std::string progress_;

  ros::Publisher model_publisher_;
  ros::Subscriber plant_subscriber_, measurement_subscriber_;
  Server server_;
  ros::WallTimer poll_timer_;
  Diagnostics diagnostics_;
};

}  // namespace fpc
