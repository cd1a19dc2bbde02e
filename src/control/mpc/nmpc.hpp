// Nonlinear model predictive control with a model of any kind: a baseline to the explicit laws.
#pragma once

#include "control/mpc/horizon_mpc.hpp"
#include "optim/gauss_newton.hpp"

namespace fpc {

/// Section `controller` of a loop file, type nmpc.
struct NmpcParams {
  HorizonParams horizon;
  GaussNewtonSettings solver;
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// The least J (see PlanCost) inside the limits, by sequential quadratic programming in inputs
/// scaled to their bounds. Deterministic, no allocation per sample. Where the solver reaches its
/// iterations the best plan so far is taken, with an event.
class Nmpc final : public HorizonMpc {
 public:
  /// @throws InputError naming the field.
  Nmpc(const NmpcParams& params, const InputLimits& limits, const PlantInfo& plant,
       std::unique_ptr<SampleModel> model);

 private:
  PlanFound search(const Measurement& now, Vector& plan) override;
  void updateLimits(VectorRef previous);
  const GaussNewtonResult& solve(VectorRef previous);

  GaussNewton solver_;
  LinearLimits box_;
  Vector scaled_, trial_;
  Residuals residuals_;
};

}  // namespace fpc
