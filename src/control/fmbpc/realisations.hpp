// The four ways to tell where the process stands. Private to the room.
#pragma once

#include <optional>

#include "control/fmbpc/internal_model.hpp"
#include "control/fmbpc/smith_predictor.hpp"
#include "estimation/model_observer.hpp"
#include "model/canonical_form.hpp"

namespace fpc {

/// Its own state, which measurements never touch; y - y_m is added to its outputs. With a delay
/// taken out y_m comes from the Smith predictor.
class ParallelModel : public InternalModel {
 public:
  ParallelModel(const TsModel& model, const FmbpcParams& params);
  void rest(const Measurement& now, VectorRef disturbances) override;
  void advance(const Measurement& now, VectorRef disturbances) override;
  void foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) override;
  bool blend(VectorRef disturbances) override;
  void compare(const Measurement& now) override;
  bool inherit(const InternalModel& older) override;

 protected:
  std::optional<SmithPredictor> delayed_;  ///< with delay_steps > 0
};

/// The same in the state space of blazic2007.
class LiteralModel final : public ParallelModel {
 public:
  LiteralModel(const TsModel& model, const FmbpcParams& params);
  void rest(const Measurement& now, VectorRef disturbances) override;
  bool blend(VectorRef disturbances) override;
  void compare(const Measurement& now) override;
  bool inherit(const InternalModel& /*older*/) override { return false; }
  const AffineModel& affine() const override { return canonical_.affine(); }

 private:
  CanonicalForm canonical_;
};

/// The state is measured; a filtered one-step error w_hat is added to it at every sample.
class RealignedModel final : public InternalModel {
 public:
  RealignedModel(const TsModel& model, const FmbpcParams& params);
  void rest(const Measurement& now, VectorRef disturbances) override;
  void advance(const Measurement& now, VectorRef disturbances) override;
  void foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) override;
  void compare(const Measurement& now) override;
  bool inherit(const InternalModel& older) override;
  double correctionOf(Eigen::Index output) const override { return error_filtered_[output]; }

 private:
  double offset_gain_;
  Vector error_filtered_;  ///< w_hat
};

/// State and disturbance are those of an observer that knows how noisy the measurements are.
class ObservedModel final : public InternalModel {
 public:
  ObservedModel(const TsModel& model, const FmbpcParams& params);
  void rest(const Measurement& now, VectorRef disturbances) override;
  void advance(const Measurement& now, VectorRef disturbances) override;
  void foresee(VectorRef input, VectorRef disturbances, Eigen::Ref<Vector> outputs) override;
  void compare(const Measurement& now) override;
  bool inherit(const InternalModel& older) override;
  double correctionOf(Eigen::Index output) const override {
    return observer_.disturbance()[output];
  }
  double estimated(std::size_t i) const override { return observer_.estimated(i); }
  void forget() override { observer_.forget(); }

 private:
  ModelObserver observer_;
};

}  // namespace fpc
