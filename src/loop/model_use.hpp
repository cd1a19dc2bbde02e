// What a loop makes of its model: where it has no data, and which inputs it moves.
#pragma once

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

/// Whether the loop's law predicts with a model that knows its data.
bool hasDomain(const LoopFile& loop);
/// Of a loop with a domain: whether outputs or disturbances, as the law had them, are where its
/// model has no data. Inputs beyond theirs are not counted: the bounds allow them.
bool isOutsideModel(const LoopFile& loop, const SampleRecord& sample);
/// Inputs that the loop's controller may move: those of its type, and of a law whose model stays
/// what it is those that the model knows.
std::vector<bool> movedInputs(const LoopFile& loop);

}  // namespace fpc
