// The little that `identify --auto` needs instead of a structure file.
#pragma once

#include <string>
#include <vector>

#include "base/csv.hpp"
#include "identification/structure.hpp"

namespace fpc::tool {

struct AutoColumns {
  std::vector<std::string> outputs, inputs, disturbances;  ///< columns of the record
  std::string time;                                        ///< column, empty: found by its name
  double sample_time_s{};                                  ///< 0: from the time column
};

/// Signals by column, missing cells stepped over, inputs that never move allowed. @throws
/// InputError naming file and column, or if neither a column of times nor a sample time is there.
Structure autoStructure(const CsvTable& table, const AutoColumns& columns,
                        std::vector<std::string>& remarks);

/// A column name as a signal name: blanks and parentheses become underscores.
std::string signalName(const std::string& column);

}  // namespace fpc::tool
