#include "ros/operator_commands.hpp"

#include <utility>

#include "fmbpc/base/text.hpp"
#include "ros/conversions.hpp"
#include "ros/queues.hpp"
#include "ros/topics.hpp"
#include "ros/wall_throttle.hpp"

namespace fpc {
namespace {

constexpr double kDeskPatience = 1.0;  // [s] of wall time

}  // namespace

OperatorState operatorStateOf(const fmbpc::OperatorState& msg) {
  OperatorState operator_state;
  operator_state.manual = msg.manual != 0;
  operator_state.manual_given = msg.manual_given != 0;
  operator_state.manual_input = Eigen::Map<const Vector>(
      msg.manual_input.data(), static_cast<Eigen::Index>(msg.manual_input.size()));
  operator_state.recipe = {msg.recipe_held != 0, msg.recipe_held_at, msg.recipe_shift};
  if (msg.adapt_given) operator_state.adapt = msg.adapt != 0;
  for (std::size_t i = 0; i < msg.setting.size() && i < msg.setting_value.size(); ++i)
    operator_state.settings.emplace_back(msg.setting[i], msg.setting_value[i]);
  for (const auto& setpoint : msg.setpoint) operator_state.setpoints.push_back(fromMsg(setpoint));
  return operator_state;
}

OperatorCommands::OperatorCommands(ros::NodeHandle node, const LoopFile& loop, std::string name,
                                   ControllerSession& session, std::function<void()> known)
    : Node(node, loop, std::move(name)),
      session_(session),
      known_(std::move(known)),
      keeper_expected_(!loop.external_plant || loop.gateway.enabled()),
      goes_on_(loop.gateway.enabled()),
      state_(node.advertise<fmbpc::OperatorState>(topics::kOperatorState, 10, true)),
      setpoint_active_(node.advertise<fmbpc::Setpoint>(topics::kSetpointActive,
                                                       queueOf(ListenerKind::kPeer), true)),
      subscriber_(subscribe(node, topics::kOperatorKept, 1, &OperatorCommands::onKept, this)) {}

void OperatorCommands::onKept(const fmbpc::OperatorState::ConstPtr& msg) {
  kept_ = *msg;
  known_();
}

bool OperatorCommands::mayStart(const Measurement& sample) {
  const bool first = session_.counts().accepted == 0;
  if (first && sample.header.step == 0 && !keeper_expected_) return true;
  if (!first && (!goes_on_ || sample.header.run_id == session_.answer().base.header.run_id))
    return true;
  if (kept_ && kept_->run_id == sample.header.run_id) {
    takeUp(*kept_);
    return true;
  }
  const double now_s = steadyNow();
  if (deadline_s_ < 0) deadline_s_ = now_s + kDeskPatience;
  if (now_s < deadline_s_) return false;
  deadline_s_ = -1;
  if (first && sample.header.step > 0 && keeper_expected_) session_.holdUntilReleased();
  return true;
}

void OperatorCommands::takeUp(const fmbpc::OperatorState& msg) {
  deadline_s_ = -1;
  changed_ = true;
  if (msg.node.empty()) return;  // nothing was asked
  if (session_.counts().accepted == 0)
    guarded(topics::kOperatorKept, [&] { restore(msg); });
  else
    session_.carryOver();
}

void OperatorCommands::restore(const fmbpc::OperatorState& msg) {
  const OperatorState operator_state = operatorStateOf(msg);
  for (const Command& setpoint : operator_state.setpoints)
    ROS_INFO("%s: setpoint of %s restored", name().c_str(), join(setpoint.name).c_str());
  if (operator_state.manual) ROS_INFO("%s: manual restored", name().c_str());
  changed_ = true;
  session_.restore(operator_state);
}

void OperatorCommands::tell(const StepHeader& sample) {
  if (!changed_) return;
  tellSetpoints();
  if (session_.counts().accepted == 0) return;  // of which run, is not known yet: it is said then
  changed_ = false;
  state_.publish(message(sample));
}

fmbpc::OperatorState OperatorCommands::message(const StepHeader& sample) const {
  const OperatorState operator_state = session_.operator_state();
  fmbpc::OperatorState msg;
  msg.header.stamp = toStamp(sample.time_ns);
  msg.run_id = sample.run_id;
  msg.node = name();
  msg.manual = operator_state.manual;
  msg.manual_given = operator_state.manual_given;
  msg.manual_input.assign(operator_state.manual_input.data(),
                          operator_state.manual_input.data() + operator_state.manual_input.size());
  msg.recipe_held = operator_state.recipe.held;
  msg.recipe_held_at = operator_state.recipe.held_at;
  msg.recipe_shift = operator_state.recipe.shift;
  msg.adapt_given = operator_state.adapt.has_value();
  msg.adapt = operator_state.adapt.value_or(false);
  for (const auto& [key, value] : operator_state.settings) {
    msg.setting.push_back(key);
    msg.setting_value.push_back(value);
  }
  for (const Command& setpoint : operator_state.setpoints)
    msg.setpoint.push_back(toSetpointMsg(setpoint));
  return msg;
}

// What stands; if nothing does, a release without names says so.
void OperatorCommands::tellSetpoints() {
  const std::vector<Command> commands = session_.setpoint().inForce();
  for (const Command& command : commands) setpoint_active_.publish(toSetpointMsg(command));
  if (commands.empty())
    setpoint_active_.publish(toSetpointMsg(Command{0, {}, {}, CommandMode::kRelease}));
}

}  // namespace fpc
