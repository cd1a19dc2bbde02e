// What a user should know of a record, and of what a model makes of it, in words.
#pragma once

#include <string>
#include <vector>

#include "identification/validation.hpp"

namespace fpc {

/// Rows of spikes and bursts of a signal: one sample far from both neighbours, where these agree
/// (12 times what is usual, by median); or up to five in a row beyond what 96 % of the samples
/// span, by half of that span, which begin and end with such a jump and leave the rest unmoved.
std::vector<Eigen::Index> outliersOf(const Eigen::Ref<const Vector>& y);
/// The same of every column. Of outputs, those that neither follow a pulse of an input (20 samples)
/// nor are explained by the inputs, see explained();
/// of inputs and disturbances, those that the outputs do not notice.
std::vector<std::vector<Eigen::Index>> outliersOf(const DataSet& data);
/// The record without them, and without frozen rows of outputs (frozenRows()): missing in outputs,
/// straight lines in inputs and disturbances, ranges as they are then. Fits and figures see this
/// one.
DataSet withoutOutliers(const DataSet& data);

/// Inputs that hardly moved, faults (record_faults.hpp), outliers, inputs that answer to outputs
/// (closed loop), a sample time far from the process' time constants (by the linear model; null:
/// not judged).
std::vector<std::string> recordRemarks(const DataSet& data, const TsModel* linear);

/// Inputs and disturbances (columns) with fewer than four moves beside others that move ten times
/// and more: what they do cannot be told from a coincidence.
std::vector<Eigen::Index> stillCauses(const DataSet& data);

/// Of a judgement: free runs that leave the data (with the sample), rows outside the ranges of the
/// model's own data, residuals that past inputs explain or that drift.
std::vector<std::string> predictionRemarks(const TsModel& model, const DataSet& data,
                                           const Matrix& one_step, const Matrix& free_run,
                                           const ValidationParams& params);

}  // namespace fpc
