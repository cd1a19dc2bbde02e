// What operators ask of a controller, said to others whenever it changes, and asked back from the
// plant by one that comes back in the middle of a run.
#pragma once

#include <fmbpc/OperatorState.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <optional>

#include "ros/node.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// What the message says, as a controller's session takes it. @throws InputError for a setpoint of
/// unknown mode.
OperatorState operatorStateOf(const fmbpc::OperatorState& msg);

class OperatorCommands : public Node {
 public:
  /// `name`: of the controller. `known` is called when what was asked before may be known now.
  OperatorCommands(ros::NodeHandle node, const LoopFile& loop, std::string name,
                   ControllerSession& session, std::function<void()> known);

  /// False: the sample is not to be answered yet, since what was asked before is not known. The
  /// first one is answered after a second, held (see ControllerSession::holdUntilReleased); the
  /// first of a new run of a real plant then begins anew.
  bool mayStart(const Measurement& sample);
  /// Says what has changed, if anything has; call it after each new answer and each service.
  void tell(const StepHeader& sample);
  void changed() { changed_ = true; }
  using Node::refused;

 private:
  void onKept(const fmbpc::OperatorState::ConstPtr& msg);
  void restore(const fmbpc::OperatorState& msg);
  void takeUp(const fmbpc::OperatorState& msg);
  fmbpc::OperatorState message(const StepHeader& sample) const;
  void tellSetpoints();

  ControllerSession& session_;
  std::function<void()> known_;
  bool keeper_expected_, goes_on_;  // the latter: the plant, without its gateway
  bool changed_{true};
  double deadline_s_{-1};
  std::optional<fmbpc::OperatorState> kept_;  // the latest word of the plant
  ros::Publisher state_, setpoint_active_;
  ros::Subscriber subscriber_;
};

}  // namespace fpc
