#include "control/mpc/plan_cost.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "base/require_numbers.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kBarelyBegun = 0.1;  // of the effect one sample later

}  // namespace

void HorizonParams::validate(Index n_y, Index n_u) const {
  require(horizon_steps >= 1, "controller.horizon_steps", "an integer >= 1");
  require(move_steps >= 1 && move_steps <= horizon_steps, "controller.move_steps",
          "an integer >= 1 and <= horizon_steps");
  require(reference_lead_steps >= 0, "controller.reference_lead_steps", "an integer >= 0");
  requireNonNegative(weight_output, n_y, "controller.weight_output");
  requireNonNegative(weight_move, n_u, "controller.weight_move");
  require(weight_output.maxCoeff() > 0.0, "controller.weight_output", "a weight > 0");
  require(reference_pole.size() == n_y && (reference_pole.array() >= 0.0).all() &&
              (reference_pole.array() < 1.0).all(),
          "controller.reference_pole", std::to_string(n_y) + " numbers >= 0 and < 1");
}

PlanCost::PlanCost(SampleModel& model, const HorizonParams& params)
    : model_(model),
      params_(params),
      n_y_(params.weight_output.size()),
      n_u_(params.weight_move.size()),
      root_output_(params.weight_output.cwiseSqrt()),
      root_move_(params.weight_move.cwiseSqrt()),
      start_(Vector::Zero(model.stateSize())),
      correction_(Vector::Zero(n_y_)),
      previous_(Vector::Zero(n_u_)),
      state_(start_),
      residuals_(residualSize()),
      reference_(Matrix::Zero(n_y_, params.horizon_steps)),
      held_(Vector::Zero(n_u_)),
      last_(Matrix::Zero(n_y_, 2)),
      stepped_(last_) {}

void PlanCost::start(VectorRef state, VectorRef correction, VectorRef disturbances,
                     VectorRef input_previous, MatrixRef reference) {
  start_ = state;
  correction_ = correction;
  disturbances_ = disturbances;
  previous_ = input_previous;
  reference_ = reference;
}

bool PlanCost::residuals(VectorRef plan, Eigen::Ref<Vector> r) {
  state_ = start_;
  const Index last = params_.move_steps - 1;
  for (Index i = 0; i < params_.horizon_steps; ++i) {
    const auto input = plan.segment(n_u_ * std::min(i, last), n_u_);
    if (!model_.step(input, disturbances_, state_)) return false;
    for (Index o = 0; o < n_y_; ++o) {
      double& y = state_[model_.outputState(o)];
      y += correction_[o];
      r[n_y_ * i + o] = root_output_[o] * (y - reference_(o, i));
    }
  }
  const Index from = n_y_ * params_.horizon_steps;
  for (Index j = 0; j < plan.size(); ++j) {
    const double before = j < n_u_ ? previous_[j] : plan[j - n_u_];
    r[from + j] = root_move_[j % n_u_] * (plan[j] - before);
  }
  return r.allFinite();
}

double PlanCost::cost(VectorRef plan) {
  return residuals(plan, residuals_) ? residuals_.squaredNorm()
                                     : std::numeric_limits<double>::infinity();
}

/// Of the inputs held_, at the horizon and one sample later; false where the model is not finite.
bool PlanCost::lastOutputs(Eigen::Ref<Matrix> outputs) {
  state_ = start_;
  for (Index i = 0; i <= params_.horizon_steps; ++i) {
    if (!model_.step(held_, disturbances_, state_)) return false;
    const Index column = i < params_.horizon_steps ? 0 : 1;
    for (Index o = 0; o < n_y_; ++o) {
      double& y = state_[model_.outputState(o)];
      y += correction_[o];
      outputs(o, column) = root_output_[o] * y;
    }
  }
  return outputs.allFinite();
}

bool PlanCost::isShortSighted(VectorRef step) {
  held_ = previous_;
  if (!lastOutputs(last_)) return false;
  for (Index a = 0; a < n_u_; ++a) {
    if (step[a] == 0.0) continue;
    held_ = previous_;
    held_[a] += step[a];
    if (!lastOutputs(stepped_)) continue;
    stepped_ -= last_;
    if (stepped_.col(0).norm() <= kBarelyBegun * stepped_.col(1).norm()) return true;
  }
  return false;
}

void clipPlan(Eigen::Ref<Vector> plan, VectorRef input_previous, const InputLimits& limits) {
  const Index n_u = input_previous.size();
  for (Index j = 0; j < plan.size(); j += n_u) {
    if (j == 0)
      limits.clip(plan.head(n_u), input_previous);
    else
      limits.clip(plan.segment(j, n_u), plan.segment(j - n_u, n_u));
  }
}

}  // namespace fpc
