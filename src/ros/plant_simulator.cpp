#include "ros/plant_simulator.hpp"

#include <algorithm>

#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/shared.hpp"
#include "ros/topics.hpp"
#include "runtime/factory.hpp"
#include "runtime/run_events.hpp"

namespace fpc {
namespace {

constexpr double kCommandBurst = 200;  // commands at once

}  // namespace

std::string PlantSimulator::idleReason(const LoopFile& loop) {
  return loop.external_plant ? loop.name + " has an external plant" : "";
}

PlantSimulator::PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop)
    : PlantSimulator(std::move(node), std::move(private_node), loop,
                     std::make_unique<SimulatedProcess>(makeSimulation(loop))) {}

PlantSimulator::PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop, std::unique_ptr<SimulatedProcess> simulation)
    : PlantNode(node, std::move(private_node), loop, std::move(simulation),
                namesOf(makePlant(loop.simulation)->description().disturbances)),
      simulation_(static_cast<SimulatedProcess&>(session().process()).simulation()),
      lines_(loop.tf.sample_lines),
      commands_(loop.ring.commands_per_s, kCommandBurst),
      state_(
          node.advertise<fmbpc::PlantState>(topics::kPlantState, queueOf(ListenerKind::kRecord))),
      effect_(node.advertise<fmbpc::CommandEffect>(topics::kDisturbanceEffect,
                                                   queueOf(ListenerKind::kRecord))),
      disturbance_subscriber_(subscribe(node, topics::kDisturbance, queueOf(ListenerKind::kViewer),
                                        &PlantSimulator::onDisturbance, this)) {
  begin();
}

std::vector<std::string> PlantSimulator::plantMissing() {
  for (const auto& [output, delay_s] : lines_.poll()) {
    const auto& outputs = simulation_.info().outputs;
    const auto found =
        std::find_if(outputs.begin(), outputs.end(),
                     [&name = output](const SignalInfo& o) { return o.name == name; });
    const auto place = static_cast<std::size_t>(found - outputs.begin());
    simulation_.setOutputDelay(place, delay_s);
  }
  return lines_.missing();
}

void PlantSimulator::afterSample() {
  publishState();
  for (const CommandEffect& effect : simulation_.effects()) effect_.publish(toMsg(effect));
}

void PlantSimulator::publishState() {
  const std::uint32_t step = simulation_.measurement().header.step;
  const std::vector<Event> events =
      joined(joined(simulation_.events(), delayEvents(loop(), simulation_.outputDelays(), step)),
             takeRefusedCommands(step));
  health().say(events);
  fmbpc::PlantState state = toMsg(simulation_.state());
  state.events = toMsg(events);
  last_ = shared(std::move(state));
  state_.publish(last_);
}

Health PlantSimulator::plantHealth() const {
  const std::vector<Event>& events = simulation_.events();
  if (events.empty()) return PlantNode::plantHealth();
  return {LoopMode::kDegraded, worstOf(events).code, textOf(events), {}};
}

void PlantSimulator::onDisturbance(const fmbpc::Disturbance::ConstPtr& msg) {
  if (!commands_.pass(steadyNow())) return;
  const auto take = [&] {
    const Command command = fromMsg(*msg);
    const std::uint32_t step = simulation_.command(command);
    ROS_INFO("plant_simulator: disturbance of %s from sample %u on", join(command.name).c_str(),
             step);
  };
  const auto refused = [&](const std::string& why) {
    effect_.publish(refusalOf(msg->header.stamp, simulation_.measurement().header, why));
  };
  guardedCommand(topics::kDisturbance, take, refused);
}

void PlantSimulator::addValues(Diagnostics::Status& status) const {
  status.add("commands dropped: too many", commands_.dropped());
}

}  // namespace fpc
