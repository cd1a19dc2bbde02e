// The rules of the fuzzy optimal law: their models, laws and disturbance estimates, and the blend
// of all at one sample. Private to the room.
#pragma once

#include <optional>
#include <vector>

#include "control/fuzzy_lq/law.hpp"
#include "estimation/model_observer.hpp"
#include "fmbpc/model/local_model.hpp"
#include "model/shared_partition.hpp"

namespace fpc {

/// One rule of all outputs.
struct FuzzyOptimalRule {
  LocalModel model;
  QuadraticLaw law;    ///< K with u(k-1) in the state
  Matrix correction;   ///< n_u n_y: effect of d_g on the input
  Vector disturbance;  ///< d_g
  Vector constant;     ///< n_u: what does not depend on state and references
};

class FuzzyOptimalCore final : public LawCore {
 public:
  /// `model` is matched to the plant. @throws InputError, see FuzzyOptimalLaw::setModel().
  FuzzyOptimalCore(const TsModel& model, const FuzzyOptimalParams& params);

  void rest(const LawSample& sample) override;
  void advance(const LawSample& sample) override;
  void foresee(VectorRef input, VectorRef past_disturbances, Eigen::Ref<Vector> outputs) override;
  bool inherit(const LawCore& older) override;
  bool look(const LawSample& sample) override;
  Proposal propose(const LawSample& sample, Vector& input) override;
  bool finite() const override { return state_.allFinite(); }
  void predict(PredictiveAction& prediction) const override;
  double signal(Eigen::Index output, std::size_t /*which*/) const override {
    return error_[output];
  }
  const Vector& referencePole() const override { return params_.reference_pole; }

 private:
  void predictOneStep(const AffineModel& model, VectorRef input);
  void see(const LawSample& sample);
  void estimate(const LawSample& sample);
  bool blend(VectorRef disturbances);
  /// u(k + i) = -K x(k + i) + forward(i).
  void forward(Eigen::Index i, Eigen::Ref<Vector> input) const;

  FuzzyOptimalParams params_;
  LocalModel local_;       ///< all rules: firing weights, blended matrices
  std::size_t partition_;  ///< output whose firing weights count
  std::vector<FuzzyOptimalRule> rules_;
  std::optional<ModelObserver> observer_;  ///< without: the measurements count as they are
  bool short_sighted_{false};              ///< some rule's horizon is too short for some input
  bool warns_{false};                      ///< of that, at a start
  Vector state_, before_;                  ///< x(k), x(k-1): measured, or as observed
  Vector predicted_;                       ///< of one rule
  Vector seen_;           ///< y(k): measured, or what the blended model and d expect
  Vector error_;          ///< y - y_hat(k|k-1), blended
  Matrix future_;         ///< col(i) = y_r(k+1+i)
  Matrix K_, reference_;  ///< blended
  Vector constant_, offset_state_, offset_output_;
};

}  // namespace fpc
