// What a loop file asks for after its run has ended. Private to the room.
#pragma once

#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

/// A remark per list of entries, and per record, of which something never acts. None of an endless
/// run.
std::vector<RunRemark> unplayedIn(const LoopFile& loop);

}  // namespace fpc
