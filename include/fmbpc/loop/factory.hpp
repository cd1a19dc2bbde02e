// Core objects from a loop file: nodes, tool and tests build them here and nowhere else.
#pragma once

#include <memory>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/control/session.hpp"
#include "fmbpc/plant/simulation.hpp"

namespace fpc {

Simulation makeSimulation(const LoopFile& loop);  ///< @throws InputError for an external plant
ControllerSession makeControllerSession(
    const LoopFile& loop);  ///< without a model: send it by setModel()
OptimizerSession makeOptimizerSession(
    const LoopFile& loop);  ///< @throws InputError without a clp section

}  // namespace fpc
