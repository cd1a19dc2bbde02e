#include "fmbpc/loop/command_player.hpp"

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// Does what a service call does; what is refused is told, and the run goes on.
struct Doer {
  const CommandTargets& targets;

  void operator()(const SetpointCommand&) const {}
  void operator()(const DisturbanceCommand&) const {}
  void operator()(const SetManual& c) const { targets.controller.manual(c.on); }
  void operator()(const SetManualInput& c) const { targets.controller.manualInput(c.input); }
  void operator()(const HoldRecipe& c) const { targets.controller.holdRecipe(c.on); }
  void operator()(const SetAdapt& c) const {
    require(targets.controller.adapt(c.on), "adapt", "a controller that adapts");
  }
  void operator()(const Retune& c) const {
    require(targets.controller.retune(c.settings), "settings", "a controller with settings");
  }
  void operator()(const UseModel& c) const { targets.controller.setModel(c.model); }
  void operator()(const Identify& c) const { targets.identify(c.window); }
};

}  // namespace

std::int64_t CommandPlayer::stampOf(const TimedCommand& command) const {
  return clock_.startNanoseconds() + std::llround(command.time_h * 3600e9);
}

std::uint32_t CommandPlayer::stepOf(const TimedCommand& command) const {
  return clock_.firstStepAt(stampOf(command));
}

void CommandPlayer::begin(const CommandTargets& targets) {
  for (const TimedCommand& timed : commands_) {
    if (const auto* setpoint = std::get_if<SetpointCommand>(&timed.what)) {
      Command command = setpoint->command;
      command.time_ns = stampOf(timed);
      targets.controller.command(command);
    } else if (const auto* disturbance = std::get_if<DisturbanceCommand>(&timed.what)) {
      Command command = disturbance->command;
      command.time_ns = stampOf(timed);
      targets.simulation.command(command);
    }
  }
}

void CommandPlayer::advance(std::uint32_t step, const CommandTargets& targets) {
  for (; next_ < commands_.size() && stepOf(commands_[next_]) <= step; ++next_) {
    try {
      std::visit(Doer{targets}, commands_[next_].what);
    } catch (const InputError& error) {
      targets.refused("sample " + std::to_string(step) + ": " + error.what());
    }
  }
}

}  // namespace fpc
