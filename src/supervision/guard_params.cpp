// Checks of section `guard`.
#include "supervision/guard_params.hpp"

#include <cmath>

#include "control/pi/pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

using Eigen::Index;

void GuardParams::validate(Index n_y, Index n_u, Index n_d) const {
  require(trust_low >= 0.0 && trust_low <= 1.0, "guard.trust_low", "a number from 0 to 1");
  require(trust_high >= trust_low && trust_high <= 1.0, "guard.trust_high",
          "a number from trust_low to 1");
  require(least_move > 0.0 && least_move <= 1.0, "guard.least_move", "a number > 0 and <= 1");
  require(look_ahead >= 0, "guard.look_ahead", "an integer >= 0");
  require(horizon_least >= 0, "guard.horizon_least", "an integer >= 0");
  require(return_samples >= 1, "guard.return_samples", "an integer >= 1");
  require(lock_samples >= 0, "guard.lock_samples", "an integer >= 0");
  require(lock_error > 0.0 && std::isfinite(lock_error), "guard.lock_error", "a number > 0");
  require(lock_step > 0.0 && lock_step <= 1.0, "guard.lock_step", "a number > 0 and <= 1");
  require(swing_move >= 0.0 && swing_move <= 1.0, "guard.swing_move", "a number from 0 to 1");
  require(swing_release >= 1, "guard.swing_release", "an integer >= 1");
  require(lock_release >= 1, "guard.lock_release", "an integer >= 1");
  for (const Index i : lock_outputs)
    require(i >= 0 && i < n_y, "guard.lock_outputs", "outputs of the plant");
  if (pi) pi->validate(n_y, n_u, n_d);
}

}  // namespace fpc
