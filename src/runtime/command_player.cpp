#include "runtime/command_player.hpp"

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"

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
  void operator()(const WatchCandidate& c) const {
    targets.controller.watch(makeCandidate(*c.loop, c.params));
  }
  void operator()(const HandOver& c) const { targets.controller.handOver(c.on); }
};

}  // namespace

// Counted in samples like the schedules of the loop file, so that k Ts is sample k.
std::uint32_t CommandPlayer::stepOf(const TimedCommand& command) const {
  return clock_.firstStepAtHours(command.time_h);
}

void CommandPlayer::begin(const CommandTargets& targets) {
  for (const TimedCommand& timed : commands_) {
    if (const auto* setpoint = std::get_if<SetpointCommand>(&timed.what)) {
      Command command = setpoint->command;
      command.time_ns = clock_.timeAt(stepOf(timed));
      targets.controller.command(command);
      if (targets.layer) targets.layer->command(command);
    } else if (const auto* disturbance = std::get_if<DisturbanceCommand>(&timed.what)) {
      Command command = disturbance->command;
      command.time_ns = clock_.timeAt(stepOf(timed));
      targets.simulation.command(command);
    }
  }
}

void CommandPlayer::advance(std::uint32_t step, const CommandTargets& targets) {
  for (; next_ < commands_.size() && stepOf(commands_[next_]) <= step; ++next_) {
    try {
      std::visit(Doer{targets}, commands_[next_].what);
    } catch (const InputError& error) {
      targets.refused(error.what());
    }
  }
}

std::string CommandPlayer::unplayed() const {
  if (next_ >= commands_.size()) return "";
  const std::size_t left = commands_.size() - next_;
  return std::to_string(left) + (left == 1 ? " command" : " commands") +
         " of the operator never played: the run ended before (the first at " +
         exactText(commands_[next_].time_h) + " h)";
}

}  // namespace fpc
