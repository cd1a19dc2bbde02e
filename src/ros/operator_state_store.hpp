// Keeps what operators have asked of a controller, and the model it works with, beside the plant:
// a controller that comes back finds both, whether or not anybody else lives. Beside a real plant
// it also asks the controller, since that plant went on while its gateway was away.
#pragma once

#include <fmbpc/FuzzyModel.h>
#include <fmbpc/LoopState.h>
#include <fmbpc/OperatorState.h>
#include <ros/ros.h>

#include <optional>
#include <string>

#include "ros/node.hpp"

namespace fpc {

class OperatorStateStore : public Node {
 public:
  /// `name`: of the plant.
  OperatorStateStore(ros::NodeHandle node, const LoopFile& loop, std::string name);
  void beginRun(std::uint64_t run_id);  ///< what was asked in the run before is forgotten
  /// Sample 0 is next: says what stands, which is nothing but for a real plant whose gateway came
  /// back.
  void start();
  /// A member of the loop has said how it is.
  void hear(const fmbpc::LoopState& state);
  /// Whether it is known what stands: a real plant's controller has been heard and, if it was in a
  /// run already, what was asked of it; after two seconds in any case.
  bool knowsWhatStands(double now_s);
  using Node::authority;

 private:
  void onState(const fmbpc::OperatorState::ConstPtr& msg);
  void onModel(const fmbpc::FuzzyModel::ConstPtr& msg);

  std::uint64_t run_id_{};
  const bool goes_on_;  // the plant, without us
  bool begun_{false}, heard_{false}, was_in_run_{false};
  double since_s_{-1};
  std::optional<fmbpc::OperatorState> standing_;  // of a run before this process
  ros::Publisher kept_, model_kept_;
  ros::Subscriber subscriber_, model_subscriber_;
};

}  // namespace fpc
