// Reads a PI from its section, of a controller or of a guard. Private to the room.
#pragma once

#include "fmbpc/control/pi/pi_reader.hpp"

namespace fpc {

/// Keys of one loop besides its gains.
void readPiTerms(YamlSection& section, PiTerms& terms, const ControllerContext& loop);

}  // namespace fpc
