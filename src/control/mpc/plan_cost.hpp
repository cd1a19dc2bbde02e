// The cost of a plan of inputs: a process simulated over the horizon, squared errors and moves.
#pragma once

#include "control/mpc/sample_model.hpp"
#include "estimation/disturbance_observer.hpp"
#include "fmbpc/base/input_limits.hpp"

namespace fpc {

struct HorizonParams {
  int horizon_steps{40};        ///< P, samples predicted
  int move_steps{1};            ///< M <= P, inputs that are free; the last one is held
  Vector weight_output;         ///< n_y, W
  Vector weight_move;           ///< n_u, L
  Vector reference_pole;        ///< n_y
  bool preview{false};          ///< references follow the setpoint schedule over the horizon
  bool observe{false};          ///< state and correction come from an observer with stated noise
  ObserverParams observer;      ///< used if observe
  int reference_lead_steps{0};  ///< y(k+i) is drawn to y_r(k + i + this)
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// J = sum_{i=1..P} |y(k+i) - y_r(k+i)|^2_W + sum_{j<M} |u(k+j) - u(k+j-1)|^2_L along
/// x(k+i+1) = F(x(k+i), u(k+i), d(k)) + correction on the rows of the outputs, in every sample: a
/// correction inside the recursion leaves no offset whatever P is. A plan stacks u(k)..u(k+M-1),
/// n_u M, in the inputs' units.
class PlanCost {
 public:
  /// Keeps a reference to `model`; sizes from the params' weights.
  PlanCost(SampleModel& model, const HorizonParams& params);
  Eigen::Index planSize() const { return n_u_ * params_.move_steps; }
  Eigen::Index residualSize() const { return n_y_ * params_.horizon_steps + planSize(); }
  /// From where plans start. reference: n_y, P columns y_r(k+1)...; correction: n_y.
  void start(VectorRef state, VectorRef correction, VectorRef disturbances,
             VectorRef input_previous, MatrixRef reference);
  /// The square roots of the terms of J. Returns false where the model is not finite.
  bool residuals(VectorRef plan, Eigen::Ref<Vector> r);
  double cost(VectorRef plan);  ///< J, infinite where the model is not finite
  /// The effect of some input on the weighted outputs has hardly begun at the horizon: less than a
  /// tenth of what it is one sample later. Every plan then costs nearly the same, or asks for huge
  /// moves. Tried from start() with each input held at its last value and at `step` beside it, n_u;
  /// inputs whose step is 0 do not count. False where the model is not finite.
  bool isShortSighted(VectorRef step);

 private:
  bool lastOutputs(Eigen::Ref<Matrix> outputs);

  SampleModel& model_;
  HorizonParams params_;
  Eigen::Index n_y_, n_u_;
  Vector root_output_, root_move_;
  Vector start_, correction_, disturbances_, previous_, state_, residuals_;
  Matrix reference_;
  Vector held_;            // inputs that stay
  Matrix last_, stepped_;  // weighted outputs at P and P + 1, n_y 2
};

/// Puts a plan inside the limits, sample after sample from `input_previous` on.
void clipPlan(Eigen::Ref<Vector> plan, VectorRef input_previous, const InputLimits& limits);

}  // namespace fpc
