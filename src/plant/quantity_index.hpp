// Where a quantity stands in a plant's list.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// Their number if there is none of that name.
inline Eigen::Index indexOf(const std::vector<Quantity>& quantities, const std::string& name) {
  return std::find_if(quantities.begin(), quantities.end(),
                      [&](const Quantity& q) { return q.name == name; }) -
         quantities.begin();
}

}  // namespace fpc
