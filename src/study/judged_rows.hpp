// Which rows of a record the benchmark judges.
#pragma once

#include <vector>

#include "base/csv.hpp"
#include "study/evaluate.hpp"

namespace fpc {

struct JudgedRows {
  std::vector<Eigen::Index> rows;
  double spacing_h{};  ///< between them
};

/// 15 minutes apart if the record is finer. The last row of the record is an end, not a sample.
/// @throws InputError naming an unknown unit of time, a hole or step back in the times, the empty
/// window.
JudgedRows judgedRows(const CsvTable& table, const EvaluateParams& params);

}  // namespace fpc
