// Fuzzy models with a state of their own, for simulation and prediction: each output has several
// members whose free runs are averaged, and its latest errors correct the next sample. Control laws
// use TsModel instead.
#pragma once

#include <vector>

#include "identification/data_set.hpp"
#include "identification/recurrent_fit.hpp"

namespace fpc {

/// One recursion in scaled units, see RecurrentShape.
struct StateMember {
  RecurrentShape shape;
  std::vector<Regressor> exogenous;  ///< inputs and disturbances with their lags
  Vector parameters;
  StartPrior prior;
};

/// The model of one output. Scaled value = (value - shift) / scale; members with `absolute` keep
/// the output's zero.
struct StateOutput {
  double shift{}, scale{1.0};
  Vector exogenous_shift, exogenous_scale;  ///< of all inputs, then all disturbances
  std::vector<StateMember> members;
  /// Error of the free run expected at k + 1: sum of correction[i] error(k - i).
  Vector correction;
  double free_run_width{}, one_step_width{};  ///< half widths of 95 % intervals, from held-out rows
};

struct StateModel {
  std::vector<StateOutput> outputs;  ///< of all outputs of the model beside it, or none
  /// @throws InputError naming the part: sizes, indices, numbers that are not finite.
  void validate(const TsModel& names) const;
};

/// Free runs (rows x n_y): every stretch of known inputs starts with an estimate of the states from
/// its first `window` samples, used but not counted (NaN there).
Matrix predictFreeRun(const StateModel& model, const DataSet& data, int window = 5);
/// One step ahead: the free run, corrected by its latest known errors.
Matrix predictOneStep(const StateModel& model, const DataSet& data, int window = 5);

/// Mean of what the members say without the most extreme quarter on each side.
double trimmedMean(std::vector<double> values);
/// Coefficients of `correction` (order 4) by least squares on errors with gaps (NaN).
Vector fitCorrection(VectorRef errors);
/// The free run corrected: y(k+1) from errors up to k.
Vector corrected(VectorRef measured, VectorRef free_run, const Vector& correction);

}  // namespace fpc
