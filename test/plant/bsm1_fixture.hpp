// BSM1 from its usual start under its constant influent, for tests.
#pragma once

#include <algorithm>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

inline Vector nominalOf(const std::vector<Quantity>& quantities) {
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = quantities[i].nominal;
  return values;
}

/// Position of a name among the plant's quantities.
inline Eigen::Index placeOf(const std::vector<Quantity>& quantities, const std::string& name) {
  return std::find_if(quantities.begin(), quantities.end(),
                      [&](const Quantity& q) { return q.name == name; }) -
         quantities.begin();
}

/// Tanks all alike and a settler with a little sludge, as users of the benchmark start it.
inline Vector bsm1Start(const PlantDescription& plant) {
  const double tank[] = {30, 2, 1100, 60, 2500, 150, 450, 1, 8, 4, 0.8, 4, 4.5};
  const double layer[] = {12, 18, 29, 69, 356, 356, 356, 356, 356, 6394};
  const int solubles[] = {0, 1, 7, 8, 9, 10, 12};
  Vector x = nominalOf(plant.states);
  for (Eigen::Index i = 0; i < 65; ++i) x[i] = tank[i % 13];
  for (Eigen::Index i = 0; i < 10; ++i) x[65 + i] = layer[i];
  for (Eigen::Index i = 0; i < 70; ++i) x[75 + i] = tank[solubles[i / 10]];
  return x;
}

}  // namespace fpc
