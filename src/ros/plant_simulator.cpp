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
constexpr double kLinkPatience = 1.0;  // [s] without a sample of another loop before that is said

std::vector<std::string> joined(std::vector<std::string> names,
                                const std::vector<std::string>& more) {
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

}  // namespace

std::string PlantSimulator::idleReason(const LoopFile& loop) {
  return loop.external_plant ? loop.name + " has an external plant" : "";
}

PlantSimulator::PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop)
    : PlantSimulator(node, private_node, loop,
                     std::make_unique<SimulatedProcess>(makeSimulation(loop))) {}

PlantSimulator::PlantSimulator(ros::NodeHandle node, ros::NodeHandle private_node,
                               const LoopFile& loop, std::unique_ptr<SimulatedProcess> simulation)
    : PlantNode(node, private_node, loop, std::move(simulation),
                namesOf(makePlant(loop.simulation)->description().disturbances)),
      simulation_(static_cast<SimulatedProcess&>(session().process()).simulation()),
      lines_(node, loop.tf.sample_lines),
      links_(node, private_node, loop.exchange.pace, LinkInbox::Of::kPlant,
             [this] { guarded(topics::kMeasurement, [this] { takeParked(); }); }),
      commands_(loop.exchange.commands_per_s, kCommandBurst),
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
  return joined(lines_.missing(), links_.missing());
}

bool PlantSimulator::prepare(ControlAction& action) {
  LinkInbox& inbox = links_.inbox();
  const std::int64_t now_ns = simulation_.measurement().header.time_ns;
  if (inbox.empty()) return true;
  if (!inbox.ready(now_ns)) return false;
  if (const auto command = inbox.command(now_ns)) simulation_.command(*command);
  inbox.replaceInputs(now_ns, simulation_.info().inputs, action.input);
  return true;
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
  if (hasParked() && session().unansweredFor(steadyNow()) > kLinkPatience)
    return {LoopMode::kStalled, EventCode::kWaiting,
            "waits for a sample of loop " + join(links_.inbox().missing()),
            links_.inbox().missing()};
  const std::vector<Event>& events = simulation_.events();
  if (events.empty()) return PlantNode::plantHealth();
  return {LoopMode::kDegraded, worstOf(events).code, textOf(events), {}};
}

void PlantSimulator::onDisturbance(const fmbpc::Disturbance::ConstPtr& msg) {
  if (!commands_.pass(steadyNow())) return;
  const auto take = [&] {
    const Command command = fromMsg(*msg);
    links_.inbox().refuseLinked(command);
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

template int runNode<PlantSimulator>(int, char**, const std::string&);

}  // namespace fpc
