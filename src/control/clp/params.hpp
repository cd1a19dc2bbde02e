// What the parts of the closed-loop paradigm share about their parameters.
#pragma once

#include "control/clp/closed_loop_paradigm.hpp"

namespace fpc {

/// True if the steady state at the setpoint is part of the problem (lq, incremental bounds).
bool needsTarget(const ClpParams& params);

/// The parameters with every absent vector given its default size and value.
/// @throws InputError naming the field
ClpParams filledIn(ClpParams params, Eigen::Index n_y, Eigen::Index n_u);

}  // namespace fpc
