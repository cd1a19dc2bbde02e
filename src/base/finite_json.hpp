// Numbers in JSON, which has no infinite ones.
#pragma once

#include <cmath>

#include "base/ordered_json.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// What is not finite, or does not exist, is null.
inline OrderedJson numberOrNull(double value) {
  return std::isfinite(value) ? OrderedJson(value) : OrderedJson(nullptr);
}

/// Reads a cost or an extreme that is null where there is none.
inline double numberOrInfinity(const OrderedJson& json) {
  return json.is_null() ? kInfinity : json.get<double>();
}

}  // namespace fpc
