#include "ros/plant_publishers.hpp"

#include <rosgraph_msgs/Clock.h>

#include "ros/conversions.hpp"
#include "ros/topics.hpp"

namespace fpc {

PlantPublishers::PlantPublishers(ros::NodeHandle node, const Simulation& simulation,
                                 bool publish_clock)
    : info_(node.advertise<fmbpc::PlantInfo>(topics::kPlantInfo, 1, true)),
      measurement_(
          node.advertise<fmbpc::Measurement>(topics::kMeasurement, topics::kRingQueue, true)),
      state_(node.advertise<fmbpc::PlantState>(topics::kPlantState, topics::kRingQueue)),
      effect_(node.advertise<fmbpc::CommandEffect>(topics::kDisturbanceEffect, topics::kRingQueue)),
      signals_(node) {
  // Latched, so that tools which start while sample 0 is held already have a time that is not 0.
  if (publish_clock)
    clock_ = node.advertise<rosgraph_msgs::Clock>(topics::kClock, topics::kViewQueue, true);
  for (const SignalInfo& output : simulation.info().outputs) signals_.add(output.name);
  for (const Quantity& disturbance : simulation.description().disturbances)
    signals_.add(disturbance.name);
  for (const SignalInfo& input : simulation.info().inputs) signals_.add(input.name);
}

void PlantPublishers::introduce(const Simulation& simulation) {
  info_.publish(toMsg(simulation.info()));
  clock(simulation.info().header.time_ns);
}

void PlantPublishers::sample(const Simulation& simulation) {
  last_ = toMsg(simulation.measurement());
  last_.header.frame_id = simulation.info().frame_id;
  measurement_.publish(last_);
  clock(simulation.measurement().header.time_ns);
  if (state_.getNumSubscribers() > 0) state_.publish(toMsg(simulation.state()));
  for (const CommandEffect& effect : simulation.effects()) effect_.publish(toMsg(effect));
  signals(simulation);
}

void PlantPublishers::resend() {
  ++resent_;
  measurement_.publish(last_);
}

void PlantPublishers::clock(std::int64_t time_ns) {
  if (!clock_) return;
  rosgraph_msgs::Clock msg;
  msg.clock = toStamp(time_ns);
  clock_.publish(msg);
}

// Outputs and disturbances of sample k; the input that acted until then, at the time from which it
// did.
void PlantPublishers::signals(const Simulation& simulation) {
  const Measurement& now = simulation.measurement();
  std::size_t index = 0;
  for (const double value : now.outputs) signals_.publish(index++, now.header.time_ns, value);
  for (const double value : simulation.state().disturbances)
    signals_.publish(index++, now.header.time_ns, value);
  if (now.header.step == 0) return;
  const std::int64_t before = simulation.clock().timeAt(now.header.step - 1);
  for (const double value : now.input_applied) signals_.publish(index++, before, value);
}

}  // namespace fpc
