#include "control/mpc/swarm_mpc.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr std::uint64_t kNext = 0x9E3779B97F4A7C15ULL;  // spreads the seeds of successive samples

}  // namespace

void SwarmMpcParams::validate(Index n_y, Index n_u) const {
  horizon.validate(n_y, n_u);
  swarm.validate();
}

SwarmMpc::SwarmMpc(const SwarmMpcParams& params, const InputLimits& limits, const PlantInfo& plant)
    : HorizonMpc(params.horizon, limits, plant),
      swarm_params_(params.swarm),
      lower_(limits.lower.replicate(params.horizon.move_steps, 1)),
      upper_(limits.upper.replicate(params.horizon.move_steps, 1)),
      trial_(lower_),
      costs_(params.swarm.particles),
      swarm_(lower_, upper_, swarm_params_) {}

void SwarmMpc::setModel(const TsModel& model) {
  predictWith(std::make_unique<FuzzySampleModel>(model));
}

PlanFound SwarmMpc::search(const Measurement& now, Vector& plan) {
  const Vector& before = now.input_applied;
  // What one move reaches is all the swarm needs to look at for the first input.
  for (Index a = 0; a < before.size(); ++a) {
    lower_[a] = std::clamp(before[a] - limits().move[a], limits().lower[a], limits().upper[a]);
    upper_[a] = std::clamp(before[a] + limits().move[a], limits().lower[a], limits().upper[a]);
  }
  swarm_.restart(lower_, upper_, swarm_params_.seed + kNext * (now.header.step + 1ULL), plan);
  for (int t = 0; t <= swarm_params_.iterations; ++t) {
    const Matrix& places = swarm_.next();
    for (Index p = 0; p < places.cols(); ++p) {
      trial_ = places.col(p);
      clipPlan(trial_, before, limits());
      costs_[p] = cost().cost(trial_);
    }
    swarm_.tell(costs_);
  }
  const SwarmResult& found = swarm_.result();
  const bool usable = std::isfinite(found.cost);
  if (usable) plan = found.best;
  return {usable, found.cost, found.evaluations,
          usable ? EventCode::kNone : EventCode::kPlanNotFound};
}

}  // namespace fpc
