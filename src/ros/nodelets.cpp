// The same classes as nodelets, all in one process: messages go from one to the next without being
// copied. Each has a queue and a thread of its own.
#include <nodelet/nodelet.h>
#include <ros/callback_queue.h>
#include <ros/spinner.h>
#include <pluginlib/class_list_macros.hpp>

#include <optional>
#include <string>

#include "ros/clp_optimizer.hpp"
#include "ros/controller_node.hpp"
#include "ros/fuzzy_identifier.hpp"
#include "ros/gateway_node.hpp"
#include "ros/loop_recorder.hpp"
#include "ros/plant_simulator.hpp"
#include "ros/target_optimizer.hpp"

namespace fpc {

/// A nodelet that cannot start ends its manager, as a node that cannot start ends its process
/// (runNode): a loop without it would stand still.
template <typename Class>
class Hosted : public nodelet::Nodelet {
 public:
  ~Hosted() override {
    spinner_.reset();
    if (running_) running_->finish();
  }

 private:
  // The manager's own threads would hand messages to an object that is still being made: as in a
  // process of its own, nothing is heard before it is.
  void onInit() override {
    ros::NodeHandle node = getNodeHandle(), private_node = getPrivateNodeHandle();
    negotiateQuickly();
    node.setCallbackQueue(&queue_);
    private_node.setCallbackQueue(&queue_);
    try {
      running_.emplace(node, private_node, getName());
      if (!running_->needed()) return;
      spinner_.emplace(1, &queue_);
      spinner_->start();
    } catch (const std::exception& error) {
      ROS_FATAL("%s: %s", getName().c_str(), error.what());
      ros::requestShutdown();
    }
  }

  ros::CallbackQueue queue_;
  std::optional<Running<Class>> running_;
  std::optional<ros::AsyncSpinner> spinner_;
};

class PlantSimulatorNodelet : public Hosted<PlantSimulator> {};
class PlantGatewayNodelet : public Hosted<GatewayNode> {};
class FuzzyIdentifierNodelet : public Hosted<FuzzyIdentifier> {};
class ControllerNodelet : public Hosted<ControllerNode> {};
class ClpOptimizerNodelet : public Hosted<ClpOptimizer> {};
class TargetOptimizerNodelet : public Hosted<TargetOptimizer> {};
class LoopRecorderNodelet : public Hosted<LoopRecorder> {};

}  // namespace fpc

PLUGINLIB_EXPORT_CLASS(fpc::PlantSimulatorNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::PlantGatewayNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::FuzzyIdentifierNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::ControllerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::ClpOptimizerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::TargetOptimizerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::LoopRecorderNodelet, nodelet::Nodelet)
