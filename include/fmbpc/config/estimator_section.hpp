// Section `estimator` of a loop file.
#pragma once

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/control/output_estimator.hpp"

namespace fpc {

/// Without outputs where the loop has no such section. @throws InputError naming file, key and what
/// was expected.
EstimatorParams readEstimator(YamlSection& root, const LoopFile& loop);
/// Of a loop that was read.
EstimatorParams estimatorOf(const LoopFile& loop);

}  // namespace fpc
