// All loops of a plant closed in one process, each sample when what it needs of other loops has
// come: the same numbers as over topics in lockstep.
#pragma once

#include <vector>

#include "config/plant_loops.hpp"
#include "runtime/run.hpp"

namespace fpc {

/// In the order of the file. `options` are for all loops. @throws InputError as runLoop(), naming
/// the loop.
std::vector<RunRecord> runPlant(const PlantLoops& plant, const RunOptions& options = {});

}  // namespace fpc
