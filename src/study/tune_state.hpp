// The state file of a tuning: all points judged so far, exactly. Private to the room.
#pragma once

#include <string>
#include <vector>

#include "study/tune.hpp"

namespace fpc {

struct TuneState {
  std::vector<TuningStep> steps;
  double seconds{};
};

/// What must not change between stopping and resuming.
std::string identityOf(const TuningObjective& objective, const SearchParams& search);
/// Written beside and moved over, so that no half of a state can stand there.
void writeState(const std::string& file, const std::string& identity, const TuneState& state);
/// @param text  what the state file holds; `file` for messages
/// @throws InputError: not a state, of another tuning.
TuneState parseState(const std::string& text, const std::string& file, const std::string& identity);

}  // namespace fpc
