// The node fmbpc_controller: whatever controller the loop file names, over topics. Each measurement
// is answered with a base action and, if the law predicts, its prediction.
#pragma once

#include <fmbpc/Candidate.h>
#include <fmbpc/CommandEffect.h>
#include <fmbpc/ControlAction.h>
#include <fmbpc/FuzzyModel.h>
#include <fmbpc/Identified.h>
#include <fmbpc/ManualInput.h>
#include <fmbpc/Measurement.h>
#include <fmbpc/PlantInfo.h>
#include <fmbpc/PredictiveAction.h>
#include <fmbpc/Setpoint.h>
#include <fmbpc/Targets.h>
#include <fmbpc/Tracking.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

#include <optional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "ros/commission_server.hpp"
#include "ros/exchange_publisher.hpp"
#include "ros/health_reporter.hpp"
#include "ros/link_listener.hpp"
#include "ros/listener_gate.hpp"
#include "ros/node.hpp"
#include "ros/operator_commands.hpp"
#include "ros/optimizer_standin.hpp"
#include "ros/plant_gate.hpp"
#include "ros/ready.hpp"
#include "ros/settings_server.hpp"
#include "ros/signal_publishers.hpp"
#include "ros/summary_listener.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/first_answers.hpp"
#include "runtime/model_inbox.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// Ready when a fitting plant has introduced itself and, for laws that need one, a fitting model
/// has come, and everybody who listens is connected. Base actions go out on base_action, or
/// straight on control_action if the loop has no optimizer (or ~final_action is true). Services:
/// ~manual (SetBool: true is manual), ~manual_input, ~hold (SetBool: true stops the setpoint
/// schedule, false lets it go on), ~adapt (SetBool: false freezes a controller that retunes
/// itself), ~candidate (Candidate: watches another law, hands over, takes back); action ~commission
/// (Commission). Settings that may change in a run are served to dynamic_reconfigure under the
/// node's name.
class ControllerNode : public Node {
 public:
  static std::string idleReason(const LoopFile&) { return ""; }  ///< every loop has a controller
  /// @throws InputError
  ControllerNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop);

 private:
  void onPlantInfo(const fmbpc::PlantInfo::ConstPtr& msg);
  void onModel(const fmbpc::FuzzyModel::ConstPtr& msg);
  void onMeasurement(const fmbpc::Measurement::ConstPtr& msg);
  void onSetpoint(const fmbpc::Setpoint::ConstPtr& msg);
  void onIdentified(const fmbpc::Identified::ConstPtr& msg);
  bool onManual(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onManualInput(fmbpc::ManualInput::Request& request, fmbpc::ManualInput::Response& response);
  bool onHold(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onCandidate(fmbpc::Candidate::Request& request, fmbpc::Candidate::Response& response);
  bool onAdapt(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  void onTargets(const fmbpc::Targets::ConstPtr& msg);
  bool hasTargets(const StepHeader& sample);
  void useModels(const StepHeader& next);
  StepHeader nextSample() const;
  bool mayAnswer(const Measurement& measurement);
  void park(const Measurement& measurement);
  void takeFromOthers(const StepHeader& sample);
  void answer(const Measurement& measurement);
  void answerParked();
  void tell();  ///< what the operator asks has changed
  void publish(bool repeated);
  void refuseModel(const std::string& why);
  void gatherEvents();
  std::string said() const;  ///< of the present sample
  void publishTracking(bool repeated);
  Health whileControlling(double now_s) const;
  void advertiseSignals();
  void publishSignals();
  void report(Diagnostics::Status& status) const;
  Health health(double now_s) const;
  std::string plantName() const;
  static std::string modelName() { return "fuzzy_identifier"; }

  LoopFile loop_;
  ControllerSession session_;
  ModelInbox inbox_;
  OperatorCommands desk_;
  Comeback comeback_;                        // before all that publishes
  std::optional<OptimizerStandin> standin_;  // of a loop with an optimizer
  std::optional<Measurement> parked_;        // waits for what must be known before it
  double parked_since_s_{}, heard_s_{};
  ReadyPublisher ready_;
  SignalPublishers signals_;
  PlantGate plant_;
  std::string model_, model_source_,
      model_problem_;                  // name of the one in use; why the latest was refused
  double model_refused_s_{};           // when
  StepHeader linked_;                  // the sample whose setpoints of other loops are taken
  StepHeader aimed_;                   // the sample that the latest targets are of
  std::vector<Event> target_events_;   // of them; until they are in an answer
  std::vector<Event> models_refused_;  // that could not be used; until they are in an answer
  std::vector<Event> events_;          // of the present answer, and what came with it

  ExchangePublisher<fmbpc::ControlAction> base_;
  ExchangePublisher<fmbpc::PredictiveAction> prediction_;
  ExchangePublisher<fmbpc::Tracking> tracking_;
  ExchangePublisher<fmbpc::CommandEffect> effect_;
  ListenerGate listeners_;
  LinkListener links_;  // of setpoints
  ros::Subscriber plant_subscriber_, model_subscriber_, measurement_subscriber_,
      identified_subscriber_, setpoint_subscriber_, targets_subscriber_;
  ros::ServiceServer manual_, manual_input_, hold_, adapt_, candidate_;
  SteadyTimer parked_timer_;
  SettingsServer settings_;
  SummaryListener summary_;
  RateLimit commands_;
  HealthReporter health_;
  SteadyTimer commission_timer_;
  CommissionServer commission_;
};

}  // namespace fpc
