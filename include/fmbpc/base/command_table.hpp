// Values that people put over named signals (setpoints, disturbances, stuck valves, sensor faults).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// What is in force on one name.
struct ActiveCommand {
  bool active{};
  CommandMode mode{CommandMode::kRelease};
  double value{};
};

/// A command and the step at which it took effect.
struct CommandEffect {
  StepHeader header;
  Command command;
};

/// Overrides and offsets of named signals, by step. A later command on a name replaces the earlier
/// one.
class CommandTable {
 public:
  /// Values of any size on these names.
  explicit CommandTable(const std::vector<std::string>& names);
  /// Overrides inside the range of each signal, offsets at most as wide as it.
  explicit CommandTable(std::vector<SignalInfo> signals);

  /// Takes a command that acts from `step` on. A release without names is one of all names.
  /// @throws InputError (nothing is taken) on an unknown name, one that comes twice, unequal
  /// lengths, a value that is not finite or beyond its range, or an unknown mode.
  void accept(const Command& asked, std::uint32_t step);
  /// Brings all commands due at or before `step` into force; returns those that just took effect.
  /// The reference stays valid until the next call.
  const std::vector<Command>& advance(std::uint32_t step);
  /// The nominal values as the commands in force change them: `values` in the order of the names.
  void apply(Eigen::Ref<Vector> values) const;
  double apply(std::size_t index, double nominal) const;
  const std::vector<ActiveCommand>& active() const { return active_; }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<SignalInfo>& signals() const { return signals_; }
  /// What has been accepted and is not in force yet, in the order in which it will be.
  std::vector<Command> waiting() const;
  /// Counts steps from 0 again after `passed` of them.
  void carryOver(std::uint32_t passed);
  void clear();  ///< releases everything and forgets what is pending

 private:
  struct Pending {
    std::uint32_t step;
    Command command;
  };
  std::size_t indexOf(const std::string& name) const;

  std::vector<SignalInfo> signals_;
  std::vector<std::string> names_;  // of them
  std::vector<ActiveCommand> active_;
  std::vector<Pending> pending_;
  std::vector<Command> effects_;
};

}  // namespace fpc
