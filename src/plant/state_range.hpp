// Whether a state is one that a plant can have. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// The first of these states that has left its range by more than `tolerance`, in words; empty if
/// none has.
std::string outsideRange(const std::vector<Quantity>& states, Eigen::Index count, VectorRef x,
                         double tolerance);

}  // namespace fpc
