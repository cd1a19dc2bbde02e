// The keys that controllers which plan by simulation share. Private to the room.
#pragma once

#include "control/mpc/plan_cost.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {

HorizonParams readHorizon(YamlSection& section, const ControllerContext& loop);

}  // namespace fpc
