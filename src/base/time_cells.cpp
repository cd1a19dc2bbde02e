#include "base/time_cells.hpp"

#include <cmath>

#include "base/csv_cell.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kMostTime = 1e11;  // seconds since 1970 come to 4.1e9 in the year 2100

/// "YYYY-MM-DD" and so on of the digits of a date from 1900 to 2100; empty for other numbers.
std::string hyphenated(double cell) {
  if (!(cell >= 19000101.0) || cell != std::floor(cell) || cell > 21001231235959.0) return "";
  const std::string digits = std::to_string(static_cast<long long>(cell));
  if (digits.size() != 8 && digits.size() != 12 && digits.size() != 14) return "";
  const std::string year = digits.substr(0, 4);
  if (year < "1900" || year > "2100") return "";
  std::string text = year + "-" + digits.substr(4, 2) + "-" + digits.substr(6, 2);
  for (std::size_t i = 8; i < digits.size(); i += 2)
    text += (i == 8 ? "T" : ":") + digits.substr(i, 2);
  return cellTime(text) ? text : "";
}

}  // namespace

void requirePlainTimes(const CsvTable& table, Eigen::Index column) {
  const auto index = static_cast<std::size_t>(column);
  if (table.rows() == 0 || (index < table.is_date.size() && table.is_date[index])) return;
  const auto cells = table.values.col(column);
  const double first = cells[0];
  const std::string where = table.at(0, column);
  const auto isDate = [](double cell) { return !hyphenated(cell).empty(); };
  bool dates = true;
  for (Eigen::Index r = 0; r < cells.size() && dates; ++r) dates = isDate(cells[r]);
  if (dates)
    throw InputError(where + ": expected times as numbers, or dates with hyphens, " +
                     hyphenated(first) + ", got " + std::to_string(static_cast<long long>(first)));
  require(!(std::abs(first) > kMostTime), where,
          "times in s, min, h or d, got " + exactText(first) +
              " (milliseconds since 1970? no unit of them is known)");
}

}  // namespace fpc
