#include "fmbpc/base/command_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr std::size_t kMostLetters = 60;  // of a name in a message

std::string shown(const std::string& name) {
  return name.size() <= kMostLetters ? name : name.substr(0, kMostLetters) + "...";
}

std::vector<SignalInfo> withoutRanges(const std::vector<std::string>& names) {
  std::vector<SignalInfo> signals;
  for (const auto& name : names) signals.push_back({name, "", -kInfinity, kInfinity});
  return signals;
}

void requireInRange(const SignalInfo& signal, CommandMode mode, double value) {
  require(std::isfinite(value), "value of " + signal.name, "a finite number");
  const std::string unit = signal.unit.empty() ? "" : " [" + signal.unit + "]";
  const double span = signal.upper - signal.lower;
  if (mode == CommandMode::kOffset)
    require(!(std::abs(value) > span), "value of " + signal.name,
            "an offset of at most " + exactText(span) + unit + ", the width of its range, got " +
                exactText(value));
  else
    require(value >= signal.lower && value <= signal.upper, "value of " + signal.name,
            "a number >= " + exactText(signal.lower) + " and <= " + exactText(signal.upper) + unit +
                ", got " + exactText(value));
}

}  // namespace

CommandTable::CommandTable(const std::vector<std::string>& names)
    : CommandTable(withoutRanges(names)) {}

CommandTable::CommandTable(std::vector<SignalInfo> signals)
    : signals_(std::move(signals)), names_(namesOf(signals_)), active_(names_.size()) {}

std::size_t CommandTable::indexOf(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  require(found != names_.end(), "name '" + shown(name) + "'", "one of " + join(names_));
  return static_cast<std::size_t>(found - names_.begin());
}

void CommandTable::accept(const Command& asked, std::uint32_t step) {
  Command command = asked;
  const bool release = command.mode == CommandMode::kRelease;
  require(release || command.mode == CommandMode::kOverride || command.mode == CommandMode::kOffset,
          "mode", "1 (override), 2 (offset) or 3 (release)");
  if (release && command.name.empty()) command.name = names_;
  require(!command.name.empty(), "name", "at least one name");
  require(command.name.size() <= names_.size(), "name",
          "at most " + std::to_string(names_.size()) + " names, not " +
              std::to_string(command.name.size()));
  require((release && command.value.empty()) || command.value.size() == command.name.size(),
          "value", "as many values as names");
  std::vector<bool> named(names_.size());
  for (std::size_t i = 0; i < command.name.size(); ++i) {
    const std::size_t index = indexOf(command.name[i]);
    require(!named[index], "name '" + command.name[i] + "'", "each name once");
    named[index] = true;
    if (!release) requireInRange(signals_[index], command.mode, command.value[i]);
  }
  pending_.push_back({step, std::move(command)});
  std::stable_sort(pending_.begin(), pending_.end(),
                   [](const Pending& a, const Pending& b) { return a.step < b.step; });
}

const std::vector<Command>& CommandTable::advance(std::uint32_t step) {
  effects_.clear();
  auto it = pending_.begin();
  for (; it != pending_.end() && it->step <= step; ++it) {
    const Command& command = it->command;
    for (std::size_t i = 0; i < command.name.size(); ++i) {
      ActiveCommand& entry = active_[indexOf(command.name[i])];
      if (command.mode == CommandMode::kRelease)
        entry = {};
      else
        entry = {true, command.mode, command.value[i]};
    }
    effects_.push_back(command);
  }
  pending_.erase(pending_.begin(), it);
  return effects_;
}

double CommandTable::apply(std::size_t index, double nominal) const {
  const ActiveCommand& entry = active_[index];
  if (!entry.active) return nominal;
  return entry.mode == CommandMode::kOverride ? entry.value : nominal + entry.value;
}

void CommandTable::apply(Eigen::Ref<Vector> values) const {
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    values[row] = apply(i, values[row]);
  }
}

std::vector<Command> CommandTable::waiting() const {
  std::vector<Command> commands;
  for (const Pending& pending : pending_) commands.push_back(pending.command);
  return commands;
}

void CommandTable::carryOver(std::uint32_t passed) {
  for (Pending& pending : pending_) pending.step -= std::min(pending.step, passed);
}

void CommandTable::clear() {
  active_.assign(names_.size(), {});
  pending_.clear();
  effects_.clear();
}

}  // namespace fpc
