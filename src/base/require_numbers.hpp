// Weights and deviations of a parameter set: how many there are, and of which sign.
#pragma once

#include <string>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// @throws InputError naming the key.
inline void requireNonNegative(const Vector& values, Eigen::Index n, const std::string& key) {
  require(values.size() == n && values.allFinite() && (values.array() >= 0.0).all(), key,
          std::to_string(n) + " finite numbers >= 0");
}

/// @throws InputError naming the key.
inline void requirePositive(const Vector& values, Eigen::Index n, const std::string& key) {
  require(values.size() == n && values.allFinite() && (values.array() > 0.0).all(), key,
          std::to_string(n) + " finite numbers > 0");
}

}  // namespace fpc
