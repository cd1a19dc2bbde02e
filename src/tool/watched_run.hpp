// A run in process that somebody watches and may end.
#pragma once

#include "runtime/run.hpp"
#include "tool/progress_bar.hpp"

namespace fpc::tool {

/// Shows its progress in `bar`, which must live longer; Ctrl-C ends it.
inline RunOptions watchedBy(ProgressBar& bar) {
  RunOptions options;
  options.progress = [&bar](std::uint32_t step, std::uint32_t samples) {
    bar.show(static_cast<double>(step) / samples);
  };
  options.stop = [] { return interruption().load(); };
  return options;
}

}  // namespace fpc::tool
