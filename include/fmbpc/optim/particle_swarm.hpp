// Particle swarm: minimises any function inside bounds, without derivatives; the same seed gives
// the same answer. Source: Kennedy and Eberhart (1995); inertia that falls: Shi and Eberhart
// (1998). The constant inertia 0.9 with C = 1.8 of Mekki and Saad does not converge.
#pragma once

#include <cstdint>
#include <functional>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct SwarmParams {
  int particles{50};
  int iterations{50};
  double inertia_start{0.9}, inertia_end{0.4};  ///< linear; 0.73 twice is Clerc's constriction
  double cognitive{1.8}, social{1.8};           ///< C1, C2; 1.496 with 0.73
  double speed_upper{0.5};  ///< largest move per iteration, as a part of each range
  std::uint64_t seed{1};
  void validate() const;  ///< @throws InputError naming the field
};

struct SwarmResult {
  Vector best;
  double cost{};  ///< infinite if no point had a finite cost
  int evaluations{};
  bool stopped{false};  ///< by the callback
};

/// After each iteration: its number and the best so far. Returns true to stop.
using SwarmProgress = std::function<bool(int iteration, const SwarmResult& best)>;

/// cost(x) for lower <= x <= upper; NaN counts as infinite. Particles that leave the box are put
/// back on its wall and lose that part of their speed. `start`, if not empty, is the first
/// particle's place. Evaluations are in a fixed order, in this thread.
/// @throws InputError naming the field: bounds not finite or of different sizes, lower > upper.
SwarmResult minimizeBySwarm(const std::function<double(const Vector&)>& cost, const Vector& lower,
                            const Vector& upper, const SwarmParams& params,
                            const Vector& start = {}, const SwarmProgress& progress = {});

}  // namespace fpc
