// Steady states of any f(x, u, d): where does a process rest while inputs and disturbances are
// held?
#pragma once

#include <functional>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Writes dx/dt = f(x, u, d). May throw; that becomes a status.
using Derivative =
    std::function<void(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt)>;

struct SteadyStateParams {
  double tolerance{1e-10};   ///< of the last Newton step, relative to the size of each state
  double state_floor{1e-3};  ///< smallest size of a state, in its unit: states near 0 are absolute
  int max_iterations{100};
  void validate() const;  ///< @throws InputError naming the field
};

enum class SteadyStateStatus {
  kSolved,
  kIterationLimit,
  kStuck,        ///< no step, however short, comes nearer
  kSingular,     ///< the Jacobian has no inverse: the steady state is not isolated
  kModelFailed,  ///< f threw or was not finite at the start or beside an iterate
};

struct SteadyState {
  SteadyStateStatus status{SteadyStateStatus::kStuck};
  Vector x;           ///< n_x, the last iterate whatever the status
  double residual{};  ///< largest |f_i| there
  int iterations{};
  bool ok() const { return status == SteadyStateStatus::kSolved; }
};

/// Newton with a Jacobian of central differences, damped by the natural monotonicity test: a step
/// counts when the next Newton step with the same Jacobian is shorter, which does not depend on the
/// units of f. Source: deuflhard2004, section 3.3. Finds
/// a steady state near `start`, stable or not.
/// @throws InputError if params are out of range or `start` is empty or not finite.
SteadyState findSteadyState(const Derivative& f, VectorRef start, VectorRef u, VectorRef d,
                            const SteadyStateParams& params = {});

}  // namespace fpc
