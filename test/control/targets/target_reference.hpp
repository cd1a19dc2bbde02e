// A reference for TargetSolver that shares no code with it: every set of limits that can be the
// active one is tried, so it is exact for a handful of unknowns and rows, and only there.
#pragma once

#include "control/targets/target_solver.hpp"

namespace fpc {

struct TargetReference {
  Vector given_up;  ///< m, as TargetSolution
  double least_cost{};
  Vector v;  ///< n, within the cost's band the nearest to rest
};

TargetReference bruteForce(const TargetProblem& problem);

}  // namespace fpc
