// What a user should know of a record, and of what a model makes of it, in words.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/fuzzy/validation.hpp"

namespace fpc {

/// Rows of samples far from both neighbours, where these agree: 12 times what is usual (by median).
std::vector<Eigen::Index> outliersOf(const Eigen::Ref<const Vector>& y);
/// The record with the outliers of its outputs missing; no fit sees them.
DataSet withoutOutliers(const DataSet& data);

/// Inputs that hardly moved, outliers, a sample time far from the process' time constants (by the
/// linear model; null: not judged).
std::vector<std::string> recordRemarks(const DataSet& data, const TsModel* linear);

/// Of a judgement: free runs that leave the data (with the sample), rows outside the ranges of the
/// model's own data, residuals that past inputs explain, feedback from the residual to later
/// inputs.
std::vector<std::string> predictionRemarks(const TsModel& model, const DataSet& data,
                                           const Matrix& one_step, const Matrix& free_run,
                                           const ValidationParams& params);

}  // namespace fpc
