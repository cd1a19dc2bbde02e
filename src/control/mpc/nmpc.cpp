#include "control/mpc/nmpc.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kOtherStarts[] = {0.5, 1.0, 0.0};  // of the range of the inputs

}  // namespace

void NmpcParams::validate(Index n_y, Index n_u) const {
  horizon.validate(n_y, n_u);
  require(solver.max_iterations >= 1, "max_iterations", "an integer >= 1");
}

Nmpc::Nmpc(const NmpcParams& params, const InputLimits& limits, const PlantInfo& plant,
           std::unique_ptr<SampleModel> model)
    : HorizonMpc(params.horizon, limits, plant),
      solver_(range().size() * params.horizon.move_steps,
              static_cast<Index>(plant.outputs.size()) * params.horizon.horizon_steps +
                  range().size() * params.horizon.move_steps,
              range().size() * (params.horizon.move_steps - 1), params.solver) {
  params.validate(static_cast<Index>(plant.outputs.size()), range().size());
  predictWith(std::move(model));
  const Index n = cost().planSize(), n_u = range().size();
  scaled_ = trial_ = Vector::Zero(n);
  box_.x_lower = Vector::Zero(n);
  box_.x_upper = Vector::Ones(n);
  for (Index j = 0; j < n; ++j)  // an input whose bounds coincide stays there
    if (limits.upper[j % n_u] == limits.lower[j % n_u]) box_.x_upper[j] = 0.0;
  box_.A = Matrix::Zero(n - n_u, n);
  for (Index j = 0; j < n - n_u; ++j) {
    box_.A(j, j) = -1.0;
    box_.A(j, j + n_u) = 1.0;
  }
  box_.a_upper = limits.move.cwiseQuotient(range()).replicate(n / n_u - 1, 1);
  box_.a_lower = -box_.a_upper;
  residuals_ = [this](VectorRef z, Eigen::Ref<Vector> r) {
    for (Index j = 0; j < z.size(); ++j) {
      const Index a = j % range().size();
      trial_[j] = this->limits().lower[a] + range()[a] * z[j];
    }
    return cost().residuals(trial_, r);
  };
}

/// The first input lies within its bounds and one move of the input in force; bounds win.
void Nmpc::updateLimits(VectorRef previous) {
  for (Index a = 0; a < previous.size(); ++a) {
    const InputLimits& l = limits();
    const double from = std::clamp(previous[a] - l.move[a], l.lower[a], l.upper[a]);
    const double to = std::clamp(previous[a] + l.move[a], l.lower[a], l.upper[a]);
    box_.x_lower[a] = (from - l.lower[a]) / range()[a];
    box_.x_upper[a] = (to - l.lower[a]) / range()[a];
  }
}

/// From the plan before; where the model is not defined along it, from inputs elsewhere.
const GaussNewtonResult& Nmpc::solve(VectorRef previous) {
  const GaussNewtonResult* found = &solver_.solve(residuals_, scaled_, box_);
  for (const double share : kOtherStarts) {
    if (found->status != SolveStatus::kInvalidProblem) break;
    for (Index j = 0; j < scaled_.size(); ++j) {
      const Index a = j % previous.size();
      trial_[j] = limits().lower[a] + range()[a] * share;
    }
    clipPlan(trial_, previous, limits());
    for (Index j = 0; j < scaled_.size(); ++j) {
      const Index a = j % previous.size();
      scaled_[j] = (trial_[j] - limits().lower[a]) / range()[a];
    }
    found = &solver_.solve(residuals_, scaled_, box_);
  }
  return *found;
}

PlanFound Nmpc::search(const Measurement& now, Vector& plan) {
  updateLimits(now.input_applied);
  const Index n_u = now.input_applied.size();
  for (Index j = 0; j < plan.size(); ++j)
    scaled_[j] = (plan[j] - limits().lower[j % n_u]) / range()[j % n_u];
  const GaussNewtonResult& found = solve(now.input_applied);
  for (Index j = 0; j < plan.size() && found.usable(); ++j)
    plan[j] = limits().lower[j % n_u] + range()[j % n_u] * found.x[j];
  const bool limited = found.status == SolveStatus::kIterationLimit;
  const EventCode event = !found.usable() ? EventCode::kPlanNotFound
                          : limited       ? EventCode::kSolverLimit
                                          : EventCode::kNone;
  return {found.usable(), found.cost, found.iterations, event};
}

}  // namespace fpc
