// An identified model as a plant, with the noise of its record: a loop on a real process can be
// rehearsed and tuned on it.
#pragma once

#include <optional>

#include "fmbpc/model/local_model.hpp"
#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// What a model leaves unexplained of its record, standard deviations per output; empty: unknown.
struct ModelErrors {
  Vector one_step;  ///< of y(k+1) predicted from measured values up to k
  Vector free_run;  ///< of y simulated from the inputs alone
};

/// White noise that makes the same two errors: of the measurement, and of a load that enters
/// y(k+1) and stays in the process.
struct ModelNoise {
  Vector measurement, load;  ///< n_y, standard deviations
};
/// With a_j the model's coefficients of its own past outputs and h the response to a unit load:
///   one_step^2 = measurement^2 (1 + sum a_j^2) + load^2,   free_run^2 = measurement^2 + load^2 sum
///   h_i^2
/// of the rules blended at rest. Where no pair of variances makes both, the one-step error is met.
ModelNoise noiseOf(const TsModel& model, const ModelErrors& errors, VectorRef outputs,
                   VectorRef input, VectorRef disturbances);

/// Where the model rests at u and d, by Newton's method from the middle of its data.
std::optional<Vector> restOf(const TsModel& model, VectorRef input, VectorRef disturbances);

/// States: the outputs; the lags are memory of the stepper, which begins at rest. Disturbances:
/// those of the model, then "load/OUTPUT" of each output (hidden): what is added to y(k+1) per
/// sample. Ranges: of the data for inputs; those of outputs and disturbances are wider by the width
/// of the data on either side. A state beyond is a failure of the step: the model says nothing of
/// it. derivatives() are per sample, (f - y) with all lags at y, u, d: the same steady states.
class ModelPlant final : public Plant {
 public:
  /// `ranges`: over those of the model, by name. Nominal is a steady state inside the data where
  /// there is one. @throws InputError, see TsModel::validate(), and for a range of no signal.
  ModelPlant(TsModel model, const ModelErrors& errors, const std::vector<SignalInfo>& ranges);
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override;
  std::unique_ptr<PlantStepper> makeStepper(double sample_time_s) const override;

 private:
  TsModel model_;
  PlantDescription description_;
  mutable LocalModel local_;  // derivatives() blends in it
  mutable Vector rest_, next_;
};

}  // namespace fpc
