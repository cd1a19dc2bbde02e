// Particle swarm: minimises any function inside bounds, without derivatives; the same seed gives
// the same answer. Source: kennedy1995; inertia that falls:
// shi1998; inertia w0 - gbest/pbest of each particle: taieb2017, eq. 20. The
// constant inertia 0.9 with C = 1.8 of mekki does not converge.
#pragma once

#include <cstdint>
#include <functional>
#include <random>

#include "fmbpc/base/types.hpp"
#include "optim/population_search.hpp"

namespace fpc {

struct SwarmParams {
  int particles{50};
  int iterations{50};
  double inertia_start{0.9}, inertia_end{0.4};  ///< linear; 0.73 twice is Clerc's constriction
  double cognitive{1.8}, social{1.8};           ///< C1, C2; 1.496 with 0.73
  double speed_upper{0.5};  ///< largest move per iteration, as a part of each range
  std::uint64_t seed{1};
  bool adaptive{false};  ///< inertia adaptive_inertia - gbest/pbest instead of the falling one
  double adaptive_inertia{1.4};  ///< w0
  void validate() const;         ///< @throws InputError naming the field
};

struct SwarmResult {
  Vector best;
  double cost{};  ///< infinite if no point had a finite cost
  int evaluations{};
  bool stopped{false};  ///< by the callback
};

/// Particles that leave the box are put back on its wall and lose that part of their speed; speeds
/// are clamped; r1 and r2 are drawn anew for every particle and dimension.
class Swarm : public PopulationSearch {
 public:
  /// `start`, if not empty, is the first particle's place.
  /// @throws InputError naming the field: bounds not finite or of different sizes, lower > upper.
  Swarm(const Vector& lower, const Vector& upper, const SwarmParams& params,
        const Vector& start = {});
  Matrix ask() override { return next(); }
  void tell(const Vector& costs) override;
  /// ask() without a copy and without allocation.
  const Matrix& next();
  /// Begins anew, in a box of the same size and without allocation; as a new swarm would.
  /// Sizes must be those of the construction.
  void restart(const Vector& lower, const Vector& upper, std::uint64_t seed, const Vector& start);
  const SwarmResult& result() const { return result_; }
  /// gbest/pbest kept in [0, 1]: 1 where both are 0 or the particle holds the best, 0 where its own
  /// best is infinite or the costs have no ratio (best < 0 < own).
  static double likeness(double best, double own);

 private:
  void scatter(const Vector& start);
  void move();

  Vector lower_, upper_;
  SwarmParams params_;
  std::mt19937_64 generator_;
  Matrix places_, speeds_, own_best_;  // one column per particle
  Vector own_cost_;
  SwarmResult result_;
  int moves_{-1};  // -1: the first generation is not asked yet
};

/// After each iteration: its number and the best so far. Returns true to stop.
using SwarmProgress = std::function<bool(int iteration, const SwarmResult& best)>;

/// cost(x) for lower <= x <= upper; NaN counts as infinite. Evaluations are in a fixed order, in
/// this thread. @throws InputError as Swarm.
SwarmResult minimizeBySwarm(const std::function<double(const Vector&)>& cost, const Vector& lower,
                            const Vector& upper, const SwarmParams& params,
                            const Vector& start = {}, const SwarmProgress& progress = {});

}  // namespace fpc
