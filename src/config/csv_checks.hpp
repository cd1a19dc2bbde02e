// A record against the plant that it is to disturb: units and ranges. Private to the room.
#pragma once

#include <vector>

#include "config/loop_file.hpp"

namespace fpc {

/// A column whose header states another unit than the disturbance needs a scale (1: it is the same
/// by another name), an offset or a mean in the loop file. @throws InputError naming file, column,
/// both units and the keys.
void checkCsvUnits(const LoopFile& loop, const std::vector<Quantity>& disturbances);

/// `values` (n_d x samples) came of these files. @throws InputError naming the file's row that
/// gives a value outside the range of its disturbance, and the key for codes of missing cells.
void checkCsvRanges(const CsvDisturbanceParams& params, const std::vector<Quantity>& disturbances,
                    const Matrix& values);

}  // namespace fpc
