// The node that stands for the process: converts, asks its session, publishes.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/Disturbance.h>
#include <fmbpc/LoopState.h>
#include <fmbpc/Tracking.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/plant_session.hpp"
#include "ros/equipment_frames.hpp"
#include "ros/health_reporter.hpp"
#include "ros/node.hpp"
#include "ros/operator_keeper.hpp"
#include "ros/plant_publishers.hpp"
#include "ros/ready.hpp"
#include "ros/run_end.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {

/// Parameters: `loop_text`; `~also_wait_for`, names beside those of loop.wait_for, separated by
/// spaces. Services: ~pause (SetBool), ~step (Trigger, while paused), ~reset (Trigger: sample 0 of
/// a new run). Its loop_state is the summary of the loop.
class PlantSimulator : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop);

 private:
  void onAction(const fmbpc::ControlAction::ConstPtr& msg);
  void onDisturbance(const fmbpc::Disturbance::ConstPtr& msg);
  void onTracking(const fmbpc::Tracking::ConstPtr& msg);
  void onLoopState(const fmbpc::LoopState::ConstPtr& msg);
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
  void report(Diagnostics::Status& status) const;
  std::vector<std::string> missing() const;

  LoopFile loop_;
  PlantSession session_;
  PlantPublishers publishers_;
  OperatorKeeper keeper_;
  ReadyListener ready_;
  EquipmentFrames frames_;
  SampleLines lines_;
  RingWatch watch_;
  RateLimit commands_;

  std::uint64_t run_id_{};
  double begun_s_, introduced_s_{}, answered_s_{}, failed_s_{-1};
  std::string failure_;
  RunEndPublisher end_;
  WallThrottle trouble_log_{1.0};

  ros::NodeHandle node_;
  ros::Subscriber action_subscriber_, disturbance_subscriber_, state_subscriber_,
      tracking_subscriber_;
  ros::ServiceServer pause_, step_, reset_;
  ros::SteadyTimer poll_timer_, pace_timer_;
  HealthReporter health_;
};

}  // namespace fpc
