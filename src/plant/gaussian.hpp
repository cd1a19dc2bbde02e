// Random numbers whose values do not depend on the standard library: only the engine,
// std::mt19937_64, is fixed by the C++ standard, its distributions are not. Box and Muller (1958).
#pragma once

#include <cmath>
#include <random>

namespace fpc {

/// Uniform in [0, 1), all 53 bits.
inline double uniform(std::mt19937_64& engine) {
  return static_cast<double>(engine() >> 11U) * 0x1p-53;
}

/// Standard normal. Takes two numbers of the engine and keeps none, so that the engine is the whole
/// state.
inline double standardNormal(std::mt19937_64& engine) {
  constexpr double kTwoPi = 6.283185307179586;
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(engine)));
  return radius * std::cos(kTwoPi * uniform(engine));
}

}  // namespace fpc
