// Which inputs of a record act within their sample: what stands in the row of y was in force when y
// was measured, or acts from then on.
#pragma once

#include <string>
#include <vector>

#include "identification/data_set.hpp"

namespace fpc {

enum class RowReading {
  kFound,  ///< by the data, see readRows()
  kNext,   ///< the inputs of a row act from then on, as loops record them
  kSame    ///< they were in force when the outputs of their row were measured
};

/// Of inputs, then disturbances.
struct ReadRows {
  std::vector<bool> same;            ///< act within their row
  std::vector<std::string> remarks;  ///< on those that do, or that may do and answer to outputs
};

/// Looks for inputs and disturbances whose value of the same row lowers the squared one-step error
/// of a linear model of y, with as many regressors, by a tenth and more. Where no past output
/// explains such an input beyond its own past (feedbackShare() with delay 1) it acts within its
/// sample; where one does, or nothing of the error is left, as under a law without noise, the
/// record is of a closed loop and the rows are read as loops write them. `constant` columns are
/// left out.
ReadRows readRows(const DataSet& data, RowReading reading);

/// The record with the columns in `same` (empty: none) moved up by one row, so that lag 0 of a
/// model, u(k) for y(k + 1), is the value in the row of y(k + 1). The last row before a gap keeps
/// its own.
DataSet asRead(DataSet data, const std::vector<bool>& same);

}  // namespace fpc
