// Section `standstill` of a loop file.
#pragma once

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/control/standstill.hpp"

namespace fpc {

/// @throws InputError naming file, key and what was expected.
StandstillParams readStandstill(YamlSection& root, const LoopFile& loop);
/// Of a loop that was read.
StandstillParams standstillOf(const LoopFile& loop);

}  // namespace fpc
