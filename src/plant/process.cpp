#include "plant/process.hpp"

#include "base/same_sample.hpp"

namespace fpc {

void Process::take(VectorRef) {}

bool Process::answers(const StepHeader& header) const {
  const Measurement& now = measurement();
  return !now.final && isSameSample(header, now.header);
}

}  // namespace fpc
