#include "fmbpc/ros/setpoint_latch.hpp"

#include "fmbpc/ros/conversions.hpp"
#include "fmbpc/ros/topics.hpp"

namespace fpc {
namespace {
const Command kNothing{0, {}, {}, CommandMode::kRelease};
}

SetpointLatch::SetpointLatch(ros::NodeHandle node, std::vector<std::string> output_names)
    : keeper_(std::move(output_names)),
      active_(node.advertise<fmbpc::Setpoint>(
          topics::kSetpointActive, topics::kViewQueue,
          [this](const ros::SingleSubscriberPublisher& listener) { onListener(listener); })),
      subscriber_(subscribe(node, topics::kSetpoint, topics::kViewQueue, &SetpointLatch::onSetpoint,
                            this)) {}

std::vector<Command> SetpointLatch::standing() const {
  std::vector<Command> commands = keeper_.inForce();
  if (commands.empty()) commands.push_back(kNothing);
  return commands;
}

void SetpointLatch::onSetpoint(const fmbpc::Setpoint::ConstPtr& msg) {
  guarded(topics::kSetpoint, [&] { keeper_.accept(fromMsg(*msg)); });
}

void SetpointLatch::onListener(const ros::SingleSubscriberPublisher& listener) {
  std::vector<Command> commands = standing();
  commands.insert(commands.end(), keeper_.waiting().begin(), keeper_.waiting().end());
  for (const Command& command : commands) listener.publish(toSetpointMsg(command));
}

void SetpointLatch::advance(std::int64_t time_ns) {
  if (!keeper_.advance(time_ns)) return;
  for (const Command& command : standing()) active_.publish(toSetpointMsg(command));
}

}  // namespace fpc
