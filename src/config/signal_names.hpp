// Names of signals as keys and as columns: none may stand for two things. Private to the room.
#pragma once

#include "config/read.hpp"

namespace fpc {

/// @throws InputError naming the signal: a name that a CSV header cannot carry, one that is a key
/// of its own in the sections that are keyed by names, or one that makes two columns of a run's
/// table the same.
void requireSignalNames(const YamlSection& plant, const LoopFile& loop, const LoopNames& names);

}  // namespace fpc
