// Random numbers whose values do not depend on the standard library: only the engine and its seed
// sequence, std::mt19937_64 and std::seed_seq, are fixed by the C++ standard, its distributions are
// not. Normal numbers after boxmuller1958.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace fpc {

/// An engine of its own for each seed and each list of further numbers (which stream, which
/// repetition): streams of one seed are independent of each other.
inline std::mt19937_64 seededEngine(std::uint64_t seed,
                                    std::initializer_list<std::uint64_t> stream) {
  const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v & 0xFFFFFFFFU); };
  std::vector<std::uint32_t> words{low(seed), low(seed >> 32U)};
  for (const std::uint64_t part : stream) words.push_back(low(part));
  std::seed_seq sequence(words.begin(), words.end());
  return std::mt19937_64(sequence);
}

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
