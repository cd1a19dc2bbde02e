// What a seed changes in a loop: its pattern, its noise, and numbers that are drawn. The same seed
// draws the same in a study and in a tuning.
#pragma once

#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "config/variation.hpp"

namespace fpc {

/// The keys of a loop that take a seed: its own where a pattern, a sensor or noise draws, and that
/// of the noise inside BSM1; `noisy`: the outputs have some.
std::vector<std::string> seededKeys(const LoopFile& loop, bool noisy);
/// Factors or numbers, in the order of `vary`.
std::vector<double> drawnBy(std::uint64_t seed, const std::vector<Variation>& vary);
/// What a drawn one is multiplied with: the loop's own number, or the plant's where the loop does
/// not say; 1 for a number. @throws InputError.
double unitOf(const Variation& variation, const LoopFile& loop);

}  // namespace fpc
