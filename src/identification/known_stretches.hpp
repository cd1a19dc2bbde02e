// Where a record knows something. Private to the room.
#pragma once

#include <vector>

#include "identification/data_set.hpp"
#include "identification/recurrent_fit.hpp"

namespace fpc {

/// Rows without gaps in which nothing at all is known; those shorter than `shortest` are left out.
std::vector<Stretch> knownStretches(const DataSet& data, Eigen::Index shortest = 1);

}  // namespace fpc
