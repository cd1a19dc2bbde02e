// Small questions about the signals of a plant, asked in every room.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// How many there are, as an index of vectors and matrices.
template <typename T>
Eigen::Index countOf(const std::vector<T>& items) {
  return static_cast<Eigen::Index>(items.size());
}

/// Their names, in the same order. Of SignalInfo, or anything else that has a name.
template <typename Named>
std::vector<std::string> namesOf(const std::vector<Named>& signals) {
  std::vector<std::string> names;
  names.reserve(signals.size());
  for (const Named& signal : signals) names.push_back(signal.name);
  return names;
}

/// Whether a law can be asked for an input: every number of the measurement is finite.
inline bool allFinite(const Measurement& m) {
  return m.outputs.allFinite() && m.disturbances.allFinite() && m.input_applied.allFinite();
}

}  // namespace fpc
