// Identification data: equally spaced rows of all signals of a structure, checked; every repair
// counted and told.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/csv.hpp"
#include "identification/structure.hpp"

namespace fpc {

/// Rows first..last of a file, counted from 1, both included. last = 0: to the end.
struct RowRange {
  Eigen::Index first{1};
  Eigen::Index last{0};
};
/// "5001:7500", "5001:" or ":5000". @throws InputError unless it has this form.
RowRange parseRows(const std::string& text);

/// Row k holds y(k) and the u(k), d(k) that act from then on.
struct DataSet {
  std::string source;  ///< the file and its rows, in words
  double sample_time_s{};
  std::vector<SignalInfo> outputs, inputs,
      disturbances;                  ///< of the structure; lower, upper: range of these data
  Matrix values;                     ///< rows x (n_y + n_u + n_d); NaN where missing
  std::vector<std::string> repairs;  ///< what was done to the data, in words with counts
  std::vector<bool>
      constant;  ///< of each column: it never moves, and its regressors are to be dropped

  Eigen::Index rows() const { return values.rows(); }
  Eigen::Index column(SignalKind kind, int index) const;
};

/// Takes the columns of the structure out of a table, over the rows of `range`.
/// @throws InputError naming file and column (or row): unknown column, another unit, implausible
/// values, no number in a column, missing cells, times unsorted or not spaced by the sample time
/// (unless structure.repair allows to mend them), constant or duplicated columns, rows outside the
/// file. Inputs and disturbances of the last row act on nothing known and may be missing.
DataSet makeDataSet(const CsvTable& table, const Structure& structure, RowRange range = {});

/// The same for signals that do not come from a file: values is rows x (n_y + n_u + n_d) in the
/// structure's order.
DataSet makeDataSet(const Matrix& values, const Structure& structure, const std::string& source);

/// Rows of one output's regression. Samples whose past or next output is missing are left out.
struct Regression {
  Matrix regressors;                 ///< n x p, values at the sample
  Matrix antecedents;                ///< n x n_a
  Vector target;                     ///< n, the output one sample later
  std::vector<Eigen::Index> sample;  ///< k of each row
  Eigen::Index rows() const { return target.size(); }
};
Regression makeRegression(const DataSet& data, const std::vector<Regressor>& regressors,
                          const std::vector<Regressor>& antecedents, int output);

}  // namespace fpc
