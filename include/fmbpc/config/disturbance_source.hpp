// The disturbances of a loop file on the samples of its run.
#pragma once

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/plant/late_rows.hpp"

namespace fpc {

/// @throws InputError for an external plant, which only runs over topics.
void requireSimulated(const LoopFile& loop);
/// The plant's disturbances, which it takes a plant to know.
std::vector<Quantity> disturbancesOf(const LoopFile& loop);
/// The disturbances of the loop on its own samples. @throws InputError naming file, column or
/// field.
DisturbanceRecord makeDisturbance(const LoopFile& loop);
/// The same, and adds the rows of a CSV file that act late to `late`.
DisturbanceRecord makeDisturbance(const LoopFile& loop, LateRows& late);

}  // namespace fpc
