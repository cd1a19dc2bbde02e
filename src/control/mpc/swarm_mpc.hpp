// Fuzzy predictive control whose moves a particle swarm finds anew in each sample: a baseline to
// the explicit laws, and a measure of what a search without derivatives costs.
#pragma once

#include "control/mpc/horizon_mpc.hpp"
#include "optim/particle_swarm.hpp"

namespace fpc {

/// Section `controller` of a loop file, type swarm_mpc.
struct SwarmMpcParams {
  HorizonParams horizon;
  SwarmParams swarm;
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// Looks for the least J (see PlanCost) of a Takagi-Sugeno model along its own path. Particles are
/// plans between the bounds, put inside the move limits before they are judged; the first one is
/// the plan of the sample before, so that no sample is worse than going on. No allocation per
/// sample. The swarm of sample k starts from a seed of its own, made of `swarm.seed` and k: same
/// file, same answer. Source: as the baseline of taieb2017, there after its
/// reference 11.
class SwarmMpc final : public HorizonMpc {
 public:
  /// @throws InputError naming the field.
  SwarmMpc(const SwarmMpcParams& params, const InputLimits& limits, const PlantInfo& plant);
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override;

 private:
  PlanFound search(const Measurement& now, Vector& plan) override;

  SwarmParams swarm_params_;
  Vector lower_, upper_, trial_, costs_;
  Swarm swarm_;
};

}  // namespace fpc
