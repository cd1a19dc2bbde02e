// The action `commission` of a controller node: the stages of a commissioning in a thread beside
// the loop that they reach into.
#pragma once

#include <actionlib/server/action_server.h>
#include <fmbpc/CommissionAction.h>
#include <ros/ros.h>

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/commissioning/plant_tap.hpp"

namespace fpc {

/// One goal at a time; a cancelled one lets go of the plant at once and ends with the stage at
/// work. poll() is to be called now and then in the node's thread.
class CommissionServer {
 public:
  struct Loop {
    /// Lets the stages reach into the loop from the next sample on. @throws InputError
    std::function<void(std::shared_ptr<PlantTap>)> tap;
    std::function<void(const Command&)> setpoint;
  };

  CommissionServer(const ros::NodeHandle& private_node, const LoopFile& loop, Loop hooks);
  ~CommissionServer();
  void poll();

 private:
  using Server = actionlib::ActionServer<fmbpc::CommissionAction>;

  void onGoal(Server::GoalHandle goal);
  void begin(const fmbpc::CommissionGoal& wish);
  double patience() const;

  const LoopFile& loop_;
  Loop hooks_;
  std::shared_ptr<PlantTap> tap_;
  std::vector<std::string> held_;  // outputs whose setpoint is the brief's, until the tap ends
  Server::GoalHandle goal_;
  std::thread thread_;
  bool cancelled_{false};

  std::mutex mutex_;  // of what follows
  std::vector<fmbpc::CommissionFeedback> news_;
  fmbpc::CommissionResult result_;
  bool over_{false};

  Server server_;  // the last: goals may come at once
};

}  // namespace fpc
