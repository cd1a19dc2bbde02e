#include "fmbpc/ros/setpoint_keeper.hpp"

#include <algorithm>

namespace fpc {

void SetpointKeeper::accept(const Command& command) {
  CommandTable(table_.names()).accept(command, 0);  // throws what is to be thrown
  waiting_.push_back(command);
}

bool SetpointKeeper::advance(std::int64_t time_ns) {
  const auto later = std::stable_partition(waiting_.begin(), waiting_.end(),
                                           [&](const Command& c) { return c.time_ns <= time_ns; });
  for (auto due = waiting_.begin(); due != later; ++due) table_.accept(*due, 0);
  waiting_.erase(waiting_.begin(), later);
  return !table_.advance(0).empty();
}

void SetpointKeeper::clear() {
  table_.clear();
  waiting_.clear();
}

std::vector<Command> SetpointKeeper::inForce() const {
  std::vector<Command> commands;
  for (const CommandMode mode : {CommandMode::kOverride, CommandMode::kOffset}) {
    Command command{0, {}, {}, mode};
    for (std::size_t i = 0; i < table_.active().size(); ++i) {
      const ActiveCommand& entry = table_.active()[i];
      if (!entry.active || entry.mode != mode) continue;
      command.name.push_back(table_.names()[i]);
      command.value.push_back(entry.value);
    }
    if (!command.name.empty()) commands.push_back(command);
  }
  return commands;
}

}  // namespace fpc
