// One run out of a bag that loop.launch recorded, for replay().
#pragma once

#include <string>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/replay.hpp"

namespace fpc {

/// The loop as the nodes read it (topic `loop_text`, written by scripts/record_bag.py).
/// @throws InputError if the bag cannot be read, or holds none or several.
std::string loopTextOf(const std::string& bag);

/// What the bag holds of one run of the loop. @throws InputError if it cannot be read, or holds
/// several plants or several runs.
RecordedRun readBagRun(const std::string& bag, const LoopFile& loop);

}  // namespace fpc
