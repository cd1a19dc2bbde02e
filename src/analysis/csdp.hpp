// One linear matrix inequality for CSDP, which runs as a program of its own (its library is not
// packaged): P in [0, I], decay^2 P - A_i' P A_i >= t I, t as large as possible.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

enum class CsdpOutcome { kSolved, kMissing, kTrouble };
CsdpOutcome solveDecay(const std::vector<Matrix>& maps, double decay, Matrix& P, double& margin);

}  // namespace fpc
