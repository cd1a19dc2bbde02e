#include "fmbpc/plant/process.hpp"

namespace fpc {

void Process::take(VectorRef) {}

bool Process::answers(const StepHeader& header) const {
  const Measurement& now = measurement();
  return !now.final && header.run_id == now.header.run_id && header.step == now.header.step;
}

}  // namespace fpc
