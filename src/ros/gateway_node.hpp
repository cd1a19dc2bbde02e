// The node plant_gateway: a plant that is not ours at the plant's end of the exchange, in realtime.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros/field.hpp"
#include "ros/plant_node.hpp"

namespace fpc {

/// See PlantNode. Sample 0 waits until every signal of the plant has come once.
class GatewayNode : public PlantNode {
 public:
  static std::string idleReason(const LoopFile& loop);
  /// @throws InputError
  GatewayNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop);
  int finish() override;

 private:
  GatewayNode(ros::NodeHandle node, ros::NodeHandle private_node, const LoopFile& loop,
              std::unique_ptr<Field> field);
  std::vector<std::string> plantMissing() override;
  VectorRef shownDisturbances() const override { return gateway_.measurement().disturbances; }
  void exchange() override;
  void mark(fmbpc::Measurement& measurement) const override;
  Health plantHealth() const override;
  void addValues(Diagnostics::Status& status) const override;

  std::unique_ptr<Field> field_;
  PlantGateway& gateway_;  // the session's
  std::string problem_;    // of the field, as it was logged
  WallThrottle problem_log_{1.0};
  SteadyTimer field_timer_;
};

}  // namespace fpc
