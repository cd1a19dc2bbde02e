// How far a model is trusted by where the process is, whatever the inputs are.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

struct TsModel;

/// trustOf() of the outputs and disturbances of `point` (n: outputs, inputs, disturbances) only. No
/// allocation.
double processTrustOf(const TsModel& model, VectorRef point);

}  // namespace fpc
