// The loop closed in one process: no master, no topics, the same objects and numbers as over
// topics.
#pragma once

#include <functional>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

struct RunOptions {
  std::function<void(std::uint32_t step, std::uint32_t samples)> progress;  ///< may be empty
  std::function<bool()> stop;  ///< true ends the run early; may be empty
};

/// @throws InputError for an external plant or an endless run.
RunRecord runLoop(const LoopFile& loop, const RunOptions& options = {});

}  // namespace fpc
