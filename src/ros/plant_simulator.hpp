// The node that stands for the process: a simulation at the plant's end of the exchange.
#pragma once

#include <fmbpc/CommandEffect.h>
#include <fmbpc/Disturbance.h>
#include <fmbpc/PlantState.h>

#include <memory>
#include <string>
#include <vector>

#include "plant/simulation.hpp"
#include "ros/link_listener.hpp"
#include "ros/plant_node.hpp"

namespace fpc {

/// See PlantNode; takes disturbances, says the states, and reads sample lines from the tf tree.
class PlantSimulator : public PlantNode {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop);

 private:
  PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop,
                 std::unique_ptr<SimulatedProcess> simulation);
  void onDisturbance(const fmbpc::Disturbance::ConstPtr& msg);
  void publishState();
  std::vector<std::string> plantMissing() override;
  bool prepare(ControlAction& action) override;
  VectorRef shownDisturbances() const override { return simulation_.state().disturbances; }
  void afterSample() override;
  void afterResend() override { state_.publish(last_); }
  std::vector<ros::Publisher> alsoRecorded() const override { return {state_, effect_}; }
  Health plantHealth() const override;
  void addValues(Diagnostics::Status& status) const override;

  Simulation& simulation_;  // the session's
  SampleLines lines_;
  LinkListener links_;
  RateLimit commands_;
  boost::shared_ptr<const fmbpc::PlantState> last_;
  ros::Publisher state_, effect_;
  ros::Subscriber disturbance_subscriber_;
};

}  // namespace fpc
