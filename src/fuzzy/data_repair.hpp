// Mends what a structure's `repair` section allows, and refuses the rest.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/fuzzy/data_set.hpp"

namespace fpc {

/// Checks the time column of the taken rows against the sample time. Sorting, if allowed, reorders
/// data.values; gaps of whole samples become missing rows. @throws InputError naming file, column
/// and row.
void repairTime(DataSet& data, const CsvTable& table, const Structure& structure,
                Eigen::Index first, Eigen::Index count);

/// Inputs and disturbances of the last row act after the data and are never used: where they are
/// missing, as in records of runs, the row before stands in. Not a repair.
void holdLastInputs(DataSet& data);

/// Missing cells: an error, interpolated, or left for makeRegression() to step over.
void repairMissing(DataSet& data, MissingCells how, const std::vector<std::string>& columns);

}  // namespace fpc
