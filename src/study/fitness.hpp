// One number for a run: the weighted sum of its performance indices.
#pragma once

#include <string>
#include <vector>

#include "config/fitness_index.hpp"
#include "config/tuning_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// @throws InputError naming the term whose signal the loop has not.
void checkFitness(const FitnessParams& fitness, const LoopFile& loop);

/// The sum over the terms; over several signals sums add up, indices of steps (rise, settling,
/// overshoot, offset, step_cost) are the mean over all steps of all outputs meant. Infinite if the
/// run is not complete or the sum not finite.
double fitness(const FitnessParams& fitness, const LoopFile& loop, const RunRecord& record);

}  // namespace fpc
