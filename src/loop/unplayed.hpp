// What a loop file asks for that does not come: after the end of the run, beyond the actuator.
// Private to the room.
#pragma once

#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

/// A remark per list of entries, and per record, of which something never acts (none of an endless
/// run), and per stuck valve that the actuator's limits hold elsewhere.
std::vector<RunRemark> unplayedIn(const LoopFile& loop);

}  // namespace fpc
