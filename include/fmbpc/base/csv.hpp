// Tables of numbers with named columns, as users keep them: comma separated, one header line, empty cell = missing.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Columns by name; a missing cell is NaN and counted per column.
struct CsvTable {
  std::string file;
  std::vector<std::string> names;  ///< header, without units
  std::vector<std::string> units;  ///< text in [] behind a name, or empty
  Matrix values;                   ///< rows x columns

  Eigen::Index rows() const { return values.rows(); }
  /// @throws InputError naming file and the known columns.
  Eigen::Index column(const std::string& name) const;
};

/// Reads a table. Header cells may carry a unit, "x[mg/l]". Dates (YYYY-MM-DD) become days since 1970-01-01.
/// Cells that are neither a number, a date nor empty are kept as NaN only in columns that hold no number at all;
/// elsewhere they are errors.
/// @throws InputError with file and line: unreadable file, no header, repeated name, a row of other length, bad cell.
CsvTable readCsv(const std::string& file);

/// Writes the table so that readCsv() gives the same doubles back (units in brackets, NaN as an empty cell).
void writeCsv(const CsvTable& table, const std::string& file);

}  // namespace fpc
