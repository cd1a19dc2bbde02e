// The rows of a record in time, with those that are missing. Private to the room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/csv.hpp"

namespace fpc {

struct CsvRows {
  std::vector<double> times;           ///< [s], first 0
  std::vector<Eigen::Index> of_table;  ///< -1: not in the file
  std::vector<Eigen::Index> before;    ///< the last row of the file that is not after this one
  std::uint64_t absent{};
};

/// Where the times jump by more than one and a half of their median interval, rows are put in.
/// @throws InputError naming file and line: unknown column, times that are missing or do not
/// increase, fewer than two rows, holes of a million rows.
CsvRows csvRows(const CsvTable& table, const std::string& time_column,
                const std::string& time_unit);

}  // namespace fpc
