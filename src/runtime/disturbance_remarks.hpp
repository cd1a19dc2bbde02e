// What the record of the disturbances tells at the end of a run. Private to the room.
#pragma once

#include "config/loop_file.hpp"
#include "runtime/report.hpp"

namespace fpc {

/// Bad cells and rows that act late, from one reading of the record; nothing
/// where it is not at hand (it is the plant's, maybe of another machine).
void addDisturbances(const LoopFile& loop, Summary& summary);

}  // namespace fpc
