// What a loop file asks and cannot have: numbers that something else in it decides, setpoints where
// its model has no data. Private to the room.
#pragma once

#include <vector>

#include "config/loop_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// A remark if disturbance.nominal tells disturbances whose values a pattern gives in the run, and
/// one per followed output that is asked beyond the range of its data in the model.
std::vector<RunRemark> overruledIn(const LoopFile& loop);

}  // namespace fpc
