// Tables of numbers with named columns, as users keep them: comma separated, one header line, empty
// cell = missing.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Columns by name; a missing cell is NaN.
struct CsvTable {
  std::string file;
  std::vector<std::string> names;  ///< header, without units
  std::vector<std::string> units;  ///< text in [] behind a name, or empty
  Matrix values;                   ///< rows x columns
  std::vector<bool> is_date{};     ///< of each column as read: it holds dates (days), not numbers

  Eigen::Index rows() const { return values.rows(); }
  /// @throws InputError naming file and the known columns.
  Eigen::Index column(const std::string& name) const;
  Eigen::Index missing(Eigen::Index column) const;  ///< number of missing cells
};

/// Reads a table. Header cells may carry a unit, "x[mg/l]". Dates (YYYY-MM-DD) become days since
/// 1970-01-01. Empty cells and "nan" are missing; infinite numbers are errors. CRLF, a byte order
/// mark and empty lines are accepted. Commas inside quotes are not. Cells that are neither a
/// number, a date nor missing are kept as NaN only in columns that hold nothing else; elsewhere
/// they are errors, and so is a column of dates and numbers.
/// @throws InputError with file and line: unreadable file, no header, repeated name, a row of other
/// length, bad cell.
CsvTable readCsv(const std::string& file);

/// Writes the table so that readCsv() gives the same doubles back (units in brackets, NaN as an
/// empty cell).
void writeCsv(const CsvTable& table, const std::string& file);

}  // namespace fpc
