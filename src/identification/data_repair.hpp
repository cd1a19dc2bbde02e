// Mends what a structure's `repair` section allows, and refuses the rest.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "identification/data_set.hpp"

namespace fpc {

/// The row of the table behind each row of the data; -1 where the table has none.
using TableRows = std::vector<Eigen::Index>;

/// Checks the time column of the taken rows against the sample time. Sorting, if allowed, reorders
/// data.values; gaps of whole samples become missing rows. @throws InputError naming file, line and
/// column.
TableRows repairTime(DataSet& data, const CsvTable& table, const Structure& structure,
                     Eigen::Index first, Eigen::Index count);

/// Inputs and disturbances of the last row act after the data and are never used: where they are
/// missing, as in records of runs, the row before stands in. Not a repair.
void holdLastInputs(DataSet& data);

/// The place of a cell, for messages: column and row of the data.
using CellName = std::function<std::string(Eigen::Index column, Eigen::Index row)>;

/// Missing and implausible cells: an error, filled, clipped, or left for makeRegression() to step
/// over, as `repair.missing` and each signal's `implausible` say.
void repairCells(DataSet& data, const Structure& structure,
                 const std::vector<StructureSignal>& signals, const CellName& where);

}  // namespace fpc
