// The plant's end of the exchange as a node, whatever plant it is: converts, asks its session,
// publishes.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/LoopState.h>
#include <fmbpc/Recorded.h>
#include <fmbpc/Tracking.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "ros/equipment_frames.hpp"
#include "ros/health_reporter.hpp"
#include "ros/listener_gate.hpp"
#include "ros/node.hpp"
#include "ros/operator_state_store.hpp"
#include "ros/plant_publishers.hpp"
#include "ros/ready.hpp"
#include "ros/run_end.hpp"
#include "ros/wall_throttle.hpp"
#include "runtime/plant_session.hpp"

namespace fpc {

/// Parameters: `loop_text`; `~also_wait_for`, names beside those of loop.wait_for, separated by
/// spaces. Services: ~pause (SetBool), ~step (Trigger, while paused), ~reset (Trigger: sample 0 of
/// a new run). Its loop_state is the summary of the loop.
class PlantNode : public Node {
 public:
  void sayLast() override;

 protected:
  /// `disturbances`: names of those that have signals. The constructor of the plant's own class
  /// calls begin() at its end.
  PlantNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop,
            std::unique_ptr<Process> process, const std::vector<std::string>& disturbances);
  void begin();

  /// What the plant itself waits for before sample 0.
  virtual std::vector<std::string> plantMissing() { return {}; }
  /// Values of the signals named at construction.
  virtual VectorRef shownDisturbances() const = 0;
  /// Before anything is decided about time, and after a command may have changed.
  virtual void exchange() {}
  /// Before an action for the present sample is taken, which it may change. False: it must wait;
  /// the plant's own class calls takeParked() when it may not have to any more.
  virtual bool prepare(ControlAction&) { return true; }
  void takeParked();
  bool hasParked() const { return parked_.has_value(); }
  /// What the plant's own class publishes for a record.
  virtual std::vector<ros::Publisher> alsoRecorded() const { return {}; }
  /// What a measurement says besides its struct.
  virtual void mark(fmbpc::Measurement&) const {}
  /// The sample has been published.
  virtual void afterSample() {}
  /// It is published again.
  virtual void afterResend() {}
  /// The plant's own trouble; automatic: none.
  virtual Health plantHealth() const { return {LoopMode::kAutomatic, EventCode::kNone, "", {}}; }
  virtual void addValues(Diagnostics::Status&) const {}

  PlantSession& session() { return session_; }
  HealthReporter& health() { return health_; }
  const PlantSession& session() const { return session_; }
  const LoopFile& loop() const { return loop_; }
  ros::NodeHandle& node() { return node_; }

 private:
  void onAction(const fmbpc::ControlAction::ConstPtr& msg, const std::string& publisher);
  bool commands(const std::string& publisher, std::uint32_t step) const;
  bool take(ControlAction action);
  void onTracking(const fmbpc::Tracking::ConstPtr& msg);
  void onRecorded(const fmbpc::Recorded::ConstPtr& msg);
  void onLoopState(const fmbpc::LoopState::ConstPtr& msg, const std::string& publisher);
  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onStep(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onPoll();
  void waitForOthers();
  void beginRun();
  void start();
  void tryAdvance();
  void publishSample();
  void armTimer();
  Health health(double now_s) const;
  Health runningHealth(double now_s) const;
  Health finishedHealth(double now_s) const;
  void report(Diagnostics::Status& status) const;

  LoopFile loop_;
  PlantSession session_;
  PlantPublishers publishers_;
  OperatorStateStore keeper_;
  ReadyListener ready_;
  std::optional<ListenerGate> listeners_;  // of the first sample: whoever records is connected
  EquipmentFrames frames_;
  const std::vector<std::string> members_;  // nodes of ours that beat
  RingWatch watch_;

  std::optional<ControlAction> parked_;  // answers the present sample, and waits
  std::uint64_t run_id_{};
  double begun_s_, introduced_s_{}, answered_s_{}, failed_s_{-1};
  std::string failure_;
  std::vector<std::string> missing_;
  std::string commander_;           // whose action acts ...
  std::uint32_t commanded_step_{};  // ... since this sample
  bool recorded_{false};
  RunEndPublisher end_;
  WallThrottle trouble_log_{1.0};

  ros::NodeHandle node_;
  ros::Subscriber action_subscriber_, state_subscriber_, recorded_subscriber_, tracking_subscriber_;
  ros::ServiceServer pause_, step_, reset_;
  SteadyTimer poll_timer_, start_timer_, pace_timer_;
  HealthReporter health_;
};

}  // namespace fpc
