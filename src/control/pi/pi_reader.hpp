// A PI out of a section of a loop file.
#pragma once

#include "control/pi/pi.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {

/// The keys of `controller` with type pi but `type`; those of `guard.pi`. finish() is the caller's.
/// @throws InputError.
PiParams readPi(YamlSection& section, const ControllerContext& loop);

}  // namespace fpc
