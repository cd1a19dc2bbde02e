#include "plant/csv_rows.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/csv_cell.hpp"
#include "base/order_statistics.hpp"
#include "base/time_cells.hpp"
#include "base/time_unit.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kHole = 1.5;        // intervals: longer ones have rows missing
constexpr double kMostAbsent = 1e6;  // rows that are missing

/// s, min, h or d for what headers write; empty for what is none of them.
std::string timeUnitIn(const std::string& header) {
  static const std::map<std::string, std::string> others{
      {"sec", "s"}, {"second", "s"}, {"seconds", "s"}, {"minute", "min"}, {"minutes", "min"},
      {"hr", "h"},  {"hour", "h"},   {"hours", "h"},   {"day", "d"},      {"days", "d"}};
  if (secondsPer(header) > 0.0) return header;
  const auto found = others.find(header);
  return found != others.end() ? found->second : "";
}

/// What a record says of its unit and what the loop file says agree.
void requireTimeUnit(const CsvTable& table, std::size_t column, const std::string& time_unit) {
  if (table.is_date[column] || column >= table.units.size()) return;
  const std::string& header = table.units[column];
  require(header.empty() || timeUnitIn(header) == time_unit,
          table.file + ":1: column '" + table.names[column] + "'",
          "[" + time_unit + "] as disturbance.csv.time_unit says, got [" + header + "]");
}

/// Seconds since the first row.
std::vector<double> timesOf(const CsvTable& table, const std::string& time_column,
                            const std::string& time_unit) {
  const Eigen::Index column = table.column(time_column);
  const auto index = static_cast<std::size_t>(column);
  requirePlainTimes(table, column);
  const double unit_s = secondsPer(table.is_date[index] ? "d" : time_unit);
  require(unit_s > 0.0, "disturbance.csv.time_unit",
          "one of " + join(timeUnits()) + ", got '" + time_unit + "'");
  requireTimeUnit(table, index, time_unit);
  const auto& cells = table.values.col(column);
  const std::string& text = table.texts[index];
  std::vector<double> times;
  for (Eigen::Index r = 0; r < table.rows(); ++r) {
    const std::string row = table.at(r, column);
    require(!std::isnan(cells[r]), row,
            text.empty() ? "a time, the cell is missing"
                         : "a number, YYYY-MM-DD or YYYY-MM-DDThh:mm:ss, got '" + text + "'" +
                               decimalHint(text));
    const double time = (cells[r] - cells[0]) * unit_s;
    require(times.empty() || time > times.back(), row,
            "increasing times, got " + exactText(cells[r]) + " after " +
                exactText(cells[std::max<Eigen::Index>(r - 1, 0)]));
    times.push_back(time);
  }
  require(times.size() >= 2, table.file + ": column '" + time_column + "'", "at least two rows");
  return times;
}

double medianInterval(const std::vector<double>& times) {
  std::vector<double> intervals;
  for (std::size_t r = 1; r < times.size(); ++r) intervals.push_back(times[r] - times[r - 1]);
  return upperMedian(std::move(intervals));
}

}  // namespace

CsvRows csvRows(const CsvTable& table, const std::string& time_column,
                const std::string& time_unit) {
  const std::vector<double> times = timesOf(table, time_column, time_unit);
  const double interval = medianInterval(times);
  CsvRows rows;
  for (std::size_t r = 0; r < times.size(); ++r) {
    const double hole = r == 0 ? 0.0 : times[r] - times[r - 1];
    const double missing = hole > kHole * interval ? std::round(hole / interval) - 1.0 : 0.0;
    const auto row = static_cast<Eigen::Index>(r);
    require(static_cast<double>(rows.absent) + missing <= kMostAbsent,
            table.at(row, table.column(time_column)),
            "times without a hole of " + exactText(missing) + " rows (another unit?)");
    for (double i = 1.0; i <= missing; ++i, ++rows.absent) {
      rows.times.push_back(times[r - 1] + i * hole / (missing + 1.0));
      rows.of_table.push_back(-1);
      rows.before.push_back(row - 1);
    }
    rows.times.push_back(times[r]);
    rows.of_table.push_back(row);
    rows.before.push_back(row);
  }
  return rows;
}

}  // namespace fpc
