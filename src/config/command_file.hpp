// What an operator does in a run, read from a file: the commands that people send over topics and
// services, each at its time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "config/loop_file.hpp"
#include "fmbpc/control/controller.hpp"

namespace fpc {

struct SetpointCommand {
  Command command;
};
struct DisturbanceCommand {
  Command command;
};
struct SetManual {
  bool on;
};
struct SetManualInput {
  Vector input;  ///< n_u
};
struct HoldRecipe {
  bool on;
};
struct SetAdapt {
  bool on;
};
struct Retune {
  Settings settings;
};
struct UseModel {
  TsModel model;
};
/// An identification by the structure of the loop file, of the newest rows (0: all).
struct Identify {
  int window;
};

/// Another loop's law beside the one in charge.
struct WatchCandidate {
  std::shared_ptr<const LoopFile> loop;
  CandidateParams params;
};
/// To the candidate that has passed, or back to the former law.
struct HandOver {
  bool on;
};

struct TimedCommand {
  double time_h{};
  std::variant<SetpointCommand, DisturbanceCommand, SetManual, SetManualInput, HoldRecipe, SetAdapt,
               Retune, UseModel, Identify, WatchCandidate, HandOver>
      what;
};

/// A list `commands` of entries {time_h: T, WHAT: ...}; docs/operators.md lists them. In the order
/// of their times, equal times as they stand. Names of models are as in a loop file.
/// @throws InputError naming file, entry and what was expected.
std::vector<TimedCommand> readCommands(const std::string& file, const LoopFile& loop);

}  // namespace fpc
