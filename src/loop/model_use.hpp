// Whether a sample is where the loop's model has no data.
#pragma once

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

/// Whether the loop's law predicts with a model that knows its data.
bool hasDomain(const LoopFile& loop);
/// Of a loop with a domain: whether outputs or disturbances, as the law had them, are where its
/// model has no data. Inputs beyond theirs are not counted: the bounds allow them.
bool isOutsideModel(const LoopFile& loop, const SampleRecord& sample);

}  // namespace fpc
