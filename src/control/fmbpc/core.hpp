// The fuzzy model-based predictive law for one model: a realisation and a law. Private to the room.
#pragma once

#include <memory>

#include "control/fmbpc/input_law.hpp"

namespace fpc {

class FmbpcCore final : public LawCore {
 public:
  /// `model` is matched to the plant; forecast outlives the core. @throws InputError as
  /// makeInternalModel().
  FmbpcCore(const TsModel& model, const FmbpcParams& params, const InputLimits& limits,
            DisturbanceForecast& forecast);

  void rest(const LawSample& sample) override;
  void forget() override { model_->forget(); }
  void advance(const LawSample& sample) override;
  void foresee(VectorRef input, VectorRef past_disturbances, Eigen::Ref<Vector> outputs) override;
  bool inherit(const LawCore& older) override;
  bool look(const LawSample& sample) override;
  Proposal propose(const LawSample& sample, Vector& input) override;
  bool finite() const override { return model_->state().allFinite(); }
  void predict(PredictiveAction& prediction) const override;
  double signal(Eigen::Index output, std::size_t which) const override;
  double estimated(std::size_t i) const override { return model_->estimated(i); }
  const Vector& referencePole() const override { return params_.reference_pole; }
  Eigen::Index plannedSteps() const override { return law_->plannedSteps(); }
  void planned(Eigen::Index i, Eigen::Ref<Vector> point) const override {
    law_->planned(*model_, i, point);
  }
  void setTrustThreshold(double threshold, Eigen::Index least) override {
    law_->setTrustThreshold(threshold, least);
  }
  /// Settings that adoptTuning() will take; allocates.
  void prepareTuning(const FmbpcParams& params);
  void adoptTuning() override;

 private:
  void drawReference(const LawSample& sample);

  FmbpcParams params_;
  std::unique_ptr<InternalModel> model_;
  std::unique_ptr<InputLaw> law_;
  Matrix future_;  ///< col(i) = y_r(k+1+i)
  FmbpcParams next_params_;
  Matrix next_future_;
};

}  // namespace fpc
