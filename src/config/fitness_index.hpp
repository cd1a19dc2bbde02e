// The indices of performance that a tuning or a study may be judged by, by name.
#pragma once

#include <string>
#include <vector>

namespace fpc {

/// Of what an index is: that decides which key names its signal.
enum class IndexOf { kOutput, kStep, kInput, kConsumption, kRun, kEffluent };

/// The names of all indices.
std::vector<std::string> fitnessIndices();
/// @throws InputError for an unknown name.
IndexOf kindOf(const std::string& index);

}  // namespace fpc
