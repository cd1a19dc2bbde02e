// All that a search over structures found, in one place: what control laws take, the linear model
// beside it, the model with a state of its own.
#pragma once

#include "identification/auto_identify.hpp"
#include "identification/validation.hpp"

namespace fpc {

/// What is known of one output beside the models.
struct IdentifiedOutput {
  ModelKind best{ModelKind::kRegressors};
  double sensor_lower{}, sensor_upper{};      ///< predictions stay inside; equal: no limits
  double free_run_width{}, one_step_width{};  ///< of the regressor model's 95 % intervals; 0: none
  /// The same of the mean of regressors and state; 0: this output has no blend.
  double blend_free_run_width{}, blend_one_step_width{};
};

/// A plain model has no outputs, no linear model and no state model.
struct IdentifiedModel {
  TsModel model;
  std::vector<OutputModel> linear;  ///< one per output, or none
  StateModel state;
  std::vector<IdentifiedOutput> outputs;  ///< one per output, or none
  /// Of inputs, then disturbances: the record's rows are read by asRead(); empty: as they are.
  std::vector<bool> same_row;
  Eigen::Index reach{};  ///< free runs start anew after so many samples; 0: never

  TsModel linearModel() const;     ///< with the names of `model`; only if there is one
  bool has(ModelKind kind) const;  ///< kBlend: of any output
};
IdentifiedModel toIdentified(const AutoIdentification& found);

/// Predictions of all outputs (rows x n_y) with half widths of their 95 % intervals (0: unknown).
struct KindPrediction {
  Matrix one_step, free_run;
  Vector one_step_width, free_run_width;
};
/// By one kind, kBlend of all outputs; @throws InputError if the model has none of that kind or
/// other signals.
KindPrediction predictKind(const IdentifiedModel& model, ModelKind kind, const DataSet& data);
/// By the best kind of each output.
KindPrediction predictBest(const IdentifiedModel& model, const DataSet& data);
/// n samples ahead from measured pasts, from at most some 5000 of them; other rows are NaN.
struct AheadPrediction {
  Matrix best;  ///< by the best kind of each output
  Matrix laws;  ///< by the model that control laws take
};
AheadPrediction predictSteps(const IdentifiedModel& model, const DataSet& data, int steps);

/// Share [%] of measured values inside prediction +- width; NaN without width.
double coverage(VectorRef measured, VectorRef predicted, double width);

}  // namespace fpc
