// Units in the header of a record beside those of the plant. Private to the room.
#pragma once

#include <vector>

#include "fmbpc/config/loop_file.hpp"

namespace fpc {

/// A column that says its unit has that of the disturbance it is, unless the loop file says how it
/// is converted (scale, offset or mean). `disturbances`: of the plant.
/// @throws InputError naming file, column, key and both units.
void requireCsvUnits(const LoopFile& loop, const std::vector<Quantity>& disturbances);

}  // namespace fpc
