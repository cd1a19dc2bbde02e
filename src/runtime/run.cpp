#include "runtime/run.hpp"

#include "runtime/loop_exchange.hpp"

namespace fpc {

RunRecord runLoop(const LoopFile& loop, const RunOptions& options) {
  LoopExchange exchange(loop, options);
  for (std::uint32_t step = 0; exchange.step(); ++step) {
    if (options.progress) options.progress(step + 1, loop.simulation.samples);
    if (options.stop && options.stop()) break;
  }
  return exchange.take();
}

}  // namespace fpc
