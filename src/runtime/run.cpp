#include "runtime/run.hpp"

#include "runtime/loop_ring.hpp"

namespace fpc {

RunRecord runLoop(const LoopFile& loop, const RunOptions& options) {
  LoopRing ring(loop, options);
  for (std::uint32_t step = 0; ring.step(); ++step) {
    if (options.progress) options.progress(step + 1, loop.simulation.samples);
    if (options.stop && options.stop()) break;
  }
  return ring.take();
}

}  // namespace fpc
