// The disturbances of a loop file on the samples of its run.
#pragma once

#include "config/loop_file.hpp"

namespace fpc {

/// @throws InputError for an external plant, which only runs over topics.
void requireSimulated(const LoopFile& loop);
/// The plant's disturbances, which it takes a plant to know.
std::vector<Quantity> disturbancesOf(const LoopFile& loop);
/// The disturbances of the loop on its own samples; of a constant source those that a caller has
/// put into loop.simulation, which no file can. @throws InputError naming file, column or
/// field.
DisturbanceRecord makeDisturbance(const LoopFile& loop);

}  // namespace fpc
