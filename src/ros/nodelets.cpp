// The same classes as nodelets, all in one process: messages go from one to the next without being
// copied. Each has a queue of its own, and one thread at a time works on it.
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <memory>
#include <optional>
#include <string>

#include "ros/clp_optimizer.hpp"
#include "ros/controller_node.hpp"
#include "ros/fuzzy_identifier.hpp"
#include "ros/gateway_node.hpp"
#include "ros/loop_recorder.hpp"
#include "ros/master_watch.hpp"
#include "ros/plant_simulator.hpp"

namespace fpc {

/// What runNode() does for a process. A nodelet that cannot start ends its manager, as a node that
/// cannot start ends its process: a loop without it would stand still.
template <typename Class>
class Hosted : public nodelet::Nodelet {
 public:
  ~Hosted() override {
    if (instance_) instance_->finish();
  }

 private:
  void onInit() override {
    const ros::NodeHandle& node = getNodeHandle();
    const ros::NodeHandle& private_node = getPrivateNodeHandle();
    try {
      const LoopFile loop = loopParameter(private_node);
      const std::string idle = Class::idleReason(loop);
      if (!idle.empty()) {
        ROS_INFO("%s: nothing to do: %s", getName().c_str(), idle.c_str());
        return;
      }
      watch_.emplace(node, private_node, loop);
      instance_ = std::make_unique<Class>(node, private_node, loop);
    } catch (const std::exception& error) {
      ROS_FATAL("%s: %s", getName().c_str(), error.what());
      ros::requestShutdown();
    }
  }

  std::optional<MasterWatch> watch_;
  std::unique_ptr<Class> instance_;
};

class PlantSimulatorNodelet : public Hosted<PlantSimulator> {};
class PlantGatewayNodelet : public Hosted<GatewayNode> {};
class FuzzyIdentifierNodelet : public Hosted<FuzzyIdentifier> {};
class ControllerNodelet : public Hosted<ControllerNode> {};
class ClpOptimizerNodelet : public Hosted<ClpOptimizer> {};
class LoopRecorderNodelet : public Hosted<LoopRecorder> {};

}  // namespace fpc

PLUGINLIB_EXPORT_CLASS(fpc::PlantSimulatorNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::PlantGatewayNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::FuzzyIdentifierNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::ControllerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::ClpOptimizerNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fpc::LoopRecorderNodelet, nodelet::Nodelet)
