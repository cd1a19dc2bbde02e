// What the files hold that a loop names. Private to the room.
#pragma once

#include <string>

#include "config/loop_file.hpp"

namespace fpc {

/// Models, structures and records in one text: part of the fingerprint of many runs, since a
/// changed file makes other runs.
std::string contentsOf(const LoopFile& loop);

}  // namespace fpc
