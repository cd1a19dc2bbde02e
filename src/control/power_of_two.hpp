// Scaling by powers of two: exact in floating point, so that a scaled bound is still the same
// bound.
#pragma once

#include <cmath>

namespace fpc {

/// The power of two next to a positive number; 1 for anything else.
inline double powerOfTwoNear(double value) {
  if (!std::isfinite(value) || !(value > 0.0)) return 1.0;
  return std::exp2(std::round(std::log2(value)));
}

}  // namespace fpc
