// What a loop file asks for that does not come: after the end of the run. Private to the room.
#pragma once

#include <vector>

#include "config/loop_file.hpp"
#include "runtime/record.hpp"

namespace fpc {

/// A remark per list of entries, and per record, of which something never acts; none of an endless
/// run.
std::vector<RunRemark> unplayedIn(const LoopFile& loop);

}  // namespace fpc
