// The node that stands for the process: holds sample 0 until everybody is ready, then answers
// actions with samples.
#pragma once

#include <fmbpc/ControlAction.h>
#include <fmbpc/Disturbance.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/step_gate.hpp"
#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/plant/simulation.hpp"
#include "fmbpc/ros/diagnostics.hpp"
#include "fmbpc/ros/equipment_frames.hpp"
#include "fmbpc/ros/node.hpp"
#include "fmbpc/ros/pacer.hpp"
#include "fmbpc/ros/plant_publishers.hpp"
#include "fmbpc/ros/ready.hpp"
#include "fmbpc/ros/wall_throttle.hpp"

namespace fpc {

/// Parameters: `loop_text`; `~also_wait_for`, names beside those of loop.wait_for, separated by
/// spaces. Services: ~pause (SetBool), ~step (Trigger, while paused), ~reset (Trigger: sample 0 of
/// a new run).
class PlantSimulator : public Node {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop);

 private:
  enum class Phase { kWaiting, kRunning, kFinished };

  void onAction(const fmbpc::ControlAction::ConstPtr& msg);
  void onDisturbance(const fmbpc::Disturbance::ConstPtr& msg);
  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool onStep(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onPoll();
  void waitForOthers();
  void beginRun();
  void start();
  bool admit(const ControlAction& action);
  void countStray(const StepHeader& header);
  void tryAdvance();
  void publishSample();
  void armTimer();
  void report(Diagnostics::Status& status) const;
  void reportWords(Diagnostics::Status& status) const;
  std::vector<std::string> missing() const;

  LoopFile loop_;
  Simulation simulation_;
  PlantPublishers publishers_;
  ReadyListener ready_;
  EquipmentFrames frames_;
  SampleLines lines_;
  Pacer pacer_;

  Phase phase_{Phase::kWaiting};
  bool paused_{false};
  std::uint32_t steps_allowed_{};  // while paused
  bool have_action_{false};
  Vector action_;  // u(k), waiting for its time
  std::uint64_t run_id_{};
  ros::WallTime begun_, sent_;
  ArrivalCounts counts_;
  std::uint64_t missing_inputs_{};
  WallThrottle trouble_log_{1.0};

  ros::Subscriber action_subscriber_, disturbance_subscriber_;
  ros::ServiceServer pause_, step_, reset_;
  ros::WallTimer poll_timer_, pace_timer_;
  Diagnostics diagnostics_;
};

}  // namespace fpc
