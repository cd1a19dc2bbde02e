// Core objects from a loop file: nodes, tool and tests build them here and nowhere else.
#pragma once

#include <memory>

#include "config/loop_file.hpp"
#include "plant/simulation.hpp"
#include "runtime/session.hpp"
#include "runtime/target_session.hpp"
#include "runtime/watched_law.hpp"

namespace fpc {

Simulation makeSimulation(const LoopFile& loop);  ///< @throws InputError for an external plant
ControllerSession makeControllerSession(
    const LoopFile& loop);  ///< without a model: send it by setModel()
/// The law and the model of another loop, to be watched beside the one in charge.
CandidateLaw makeCandidate(const LoopFile& other, const CandidateParams& params);
TargetSession makeTargetSession(
    const LoopFile& loop);  ///< without a model. @throws InputError without a section targets
OptimizerSession makeOptimizerSession(
    const LoopFile& loop);  ///< @throws InputError without a clp section

}  // namespace fpc
