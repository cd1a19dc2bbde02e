// Which rule may stand in for one without data.
#pragma once

#include <vector>

#include "identification/consequents.hpp"

namespace fpc {

/// The fitted rule whose sets lie nearest to those of rule i, out of those with the same crisp sets
/// (operating mode); -1 if there is none.
int nearestFitted(const OutputModel& model, const std::vector<RuleFit>& fits, std::size_t i);

}  // namespace fpc
