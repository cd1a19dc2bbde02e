// The loop closed in one process: no master, no topics, the same sessions and numbers as over
// topics.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "config/command_file.hpp"
#include "config/loop_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

struct RunOptions {
  std::function<void(std::uint32_t step, std::uint32_t samples)> progress;  ///< may be empty
  std::function<bool()> stop;  ///< true ends the run early; may be empty
  std::vector<TimedCommand> commands;
  /// A model that was identified in the run, and what was refused or failed; may be empty.
  std::function<void(const TsModel& model)> identified;
  std::function<void(const Event& event)> said;
};

/// Sample k is answered, recorded and learned from; a model made from it (model.identify, online
/// learning) is used from sample k + 1 on, as over topics in lockstep.
/// @throws InputError for an external plant, an endless run, or without the model a law needs.
RunRecord runLoop(const LoopFile& loop, const RunOptions& options = {});

}  // namespace fpc
