// Tables of numbers with named columns, as users keep them: one header line, empty cell = missing.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// How a file is written. Cells that are empty or "nan" are missing whatever else is.
struct CsvFormat {
  char separator{','};  ///< of columns: ',', ';', '|' or tab
  char decimal{'.'};    ///< '.' or ','
  std::vector<std::string>
      missing_values;     ///< cells that mean "missing": the same text, or the same number (-999)
  void validate() const;  ///< @throws InputError naming the field
};

/// The character of comma, semicolon, tab, bar, or the character itself. @throws InputError for
/// another word.
char separatorOf(const std::string& word);
char decimalOf(const std::string& word);  ///< of point or comma, likewise

/// Columns by name; a missing cell is NaN.
struct CsvTable {
  std::string file;
  std::vector<std::string> names;    ///< header, without units
  std::vector<std::string> units;    ///< text in [] behind a name, or empty
  Matrix values;                     ///< rows x columns
  std::vector<bool> is_date{};       ///< of each column as read: it holds dates (days), not numbers
  std::vector<std::size_t> lines{};  ///< of the file, for each row; empty if it was no file
  std::vector<std::string> texts{};  ///< of each column: the first cell that is no number, or empty

  Eigen::Index rows() const { return values.rows(); }
  /// @throws InputError naming file and the known columns.
  Eigen::Index column(const std::string& name) const;
  Eigen::Index missing(Eigen::Index column) const;  ///< number of missing cells
  /// "influent.csv:12: column 'q'", for messages.
  std::string at(Eigen::Index row, Eigen::Index column) const;
};

/// Reads a table. Header cells may carry a unit, "x[mg/l]". Dates and times of ISO 8601
/// (YYYY-MM-DD, with T or a space hh:mm or hh:mm:ss, fractions, Z or +hh:mm) become days since
/// 1970-01-01 (UTC if the zone is given). Empty cells, "nan" and the format's missing values are
/// missing; infinite numbers are errors. CRLF, a byte order mark, empty lines and quoted cells are
/// accepted. Cells that are neither a number, a date nor missing are kept as NaN only in columns
/// that hold nothing else; elsewhere they are errors, and so is a column of dates and numbers, or
/// of times with and without a zone.
/// @throws InputError with file and line: unreadable file, no header, repeated name, a row of other
/// length, bad cell.
CsvTable readCsv(const std::string& file, const CsvFormat& format = {});

/// Writes the table so that readCsv() gives the same doubles back (units in brackets, NaN as an
/// empty cell).
void writeCsv(const CsvTable& table, const std::string& file);

}  // namespace fpc
