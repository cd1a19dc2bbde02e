// Values that people put over named signals (setpoints, disturbances, stuck valves, sensor faults).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/ring.hpp"
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
  explicit CommandTable(std::vector<std::string> names);

  /// Takes a command that acts from `step` on.
  /// @throws InputError (nothing is taken) on an unknown name, one that comes twice, unequal
  /// lengths, a non-finite value or an unknown mode.
  void accept(const Command& command, std::uint32_t step);
  /// Brings all commands due at or before `step` into force; returns those that just took effect.
  /// The reference stays valid until the next call.
  const std::vector<Command>& advance(std::uint32_t step);
  /// The nominal values as the commands in force change them: `values` in the order of the names.
  void apply(Eigen::Ref<Vector> values) const;
  double apply(std::size_t index, double nominal) const;
  const std::vector<ActiveCommand>& active() const { return active_; }
  const std::vector<std::string>& names() const { return names_; }
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

  std::vector<std::string> names_;
  std::vector<ActiveCommand> active_;
  std::vector<Pending> pending_;
  std::vector<Command> effects_;
};

}  // namespace fpc
