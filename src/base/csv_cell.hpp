// One line of a table, and what a cell of it says. Private to the package.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/csv.hpp"

namespace fpc {

/// The cells between separators, without quotes and blanks around them; separators inside quotes
/// belong to the cell, and a doubled quote is one.
std::vector<std::string> cellsOf(const std::string& line, char separator);

/// A finite number, or NaN for a missing cell; empty for anything else.
std::optional<double> cellNumber(const std::string& cell, const CsvFormat& format);

/// " (decimal: point; is it comma?)" of a text that is a number with the other decimal; else empty.
std::string decimalHint(const std::string& text, char decimal);
/// The same of a text that was no number: a comma was not the decimal then, nor a point otherwise.
inline std::string decimalHint(const std::string& text) {
  return decimalHint(text, text.find(',') != std::string::npos ? '.' : ',');
}

/// A moment of ISO 8601.
struct CellTime {
  double days{};  ///< since 1970-01-01
  bool zoned{false};
};
std::optional<CellTime> cellTime(const std::string& cell);

}  // namespace fpc
