// What a model says about data, and how far that is from the data.
#pragma once

#include "identification/data_set.hpp"

namespace fpc {

/// Predictions from measured pasts (rows x n_y): row k + 1 from the data up to k; NaN where the
/// past is incomplete. The model's signals must be those of the data, in the same order. @throws
/// InputError otherwise.
Matrix predictOneStep(const TsModel& model, const DataSet& data);

/// Predictions from the model's own pasts: measured outputs only start it, at the first complete
/// sample and after every gap in inputs or disturbances. NaN before the start. A run that leaves
/// the range of the data by more than 100 spans is held there.
Matrix predictFreeRun(const TsModel& model, const DataSet& data);

/// Distances between a measured output and its prediction, over the rows where both are finite.
struct FitFigures {
  double rmse{}, mse{};    ///< in the unit of the output (squared)
  double vaf{};            ///< [%] 100 (1 - var(y - p) / var(y)): blind to a constant error
  double fit{};            ///< [%] 100 (1 - |y - p| / |y - mean(y)|)
  Eigen::Index samples{};  ///< rows compared
};
FitFigures fitFigures(VectorRef measured, VectorRef predicted);

}  // namespace fpc
