// Whether two headers are of one sample.
#pragma once

#include "fmbpc/base/exchange.hpp"

namespace fpc {

inline bool isSameSample(const StepHeader& a, const StepHeader& b) {
  return a.run_id == b.run_id && a.step == b.step;
}

}  // namespace fpc
