#include "study/judged_rows.hpp"

#include <algorithm>
#include <cmath>

#include "base/time_unit.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kSample_h = 0.25;
constexpr double kWeek_h = 168.0;
constexpr double kRounded = 0.02;  // of a sample: what files round

/// Hours since the first row.
Vector hoursOf(const CsvTable& table) {
  const Eigen::Index column = table.column("time");
  const auto index = static_cast<std::size_t>(column);
  const bool dates = index < table.is_date.size() && table.is_date[index];
  const std::string unit = dates ? "d" : table.units[index].empty() ? "h" : table.units[index];
  const double unit_s = secondsPer(unit);
  require(unit_s > 0.0, table.file + ": column 'time'",
          "one of " + join(timeUnits()) + ", got [" + unit + "]");
  return (table.values.col(column).array() - table.values(0, column)) * (unit_s / 3600.0);
}

void requireNoHole(const CsvTable& table, const Vector& hours, Eigen::Index first,
                   Eigen::Index last, double sample) {
  for (Eigen::Index r = std::max<Eigen::Index>(first, 1); r <= last; ++r) {
    const double step = hours[r] - hours[r - 1];
    require(std::abs(step - sample) <= kRounded * sample, table.at(r, table.column("time")),
            exactText(std::round(6e4 * sample) / 1e3) +
                " min after the row before it, as at the record's begin, got " +
                exactText(std::round(6e4 * step) / 1e3) + " (--from-h and --to-h leave rows out)");
  }
}

}  // namespace

JudgedRows judgedRows(const CsvTable& table, const EvaluateParams& params) {
  const Eigen::Index rows = table.rows();
  require(rows >= 3, table.file,
          "a record of three rows at least: a longer run, or an earlier report.record_from_h");
  const Vector hours = hoursOf(table);
  const double sample = hours[1], end = hours[rows - 1];
  require(sample > 0.0 && std::isfinite(end), table.file + ": column 'time'", "increasing times");
  const double to = params.to_h < 0.0 ? end : params.to_h;
  const double from = params.from_h < 0.0 ? std::max(0.0, to - kWeek_h) : params.from_h;
  const double ratio = kSample_h / sample;
  const bool thin = ratio > 1.5 && std::abs(ratio - std::round(ratio)) < 1e-3;
  const auto stride = static_cast<Eigen::Index>(thin ? std::lround(ratio) : 1);
  JudgedRows judged;
  judged.spacing_h = sample * static_cast<double>(stride);
  Eigen::Index first = 0;
  while (first < rows && hours[first] < from - 1e-6 * std::max(1.0, from)) ++first;
  for (Eigen::Index r = first; r < rows - 1; r += stride)
    if (hours[r] < to - kRounded * sample) judged.rows.push_back(r);
  require(judged.rows.size() >= 2, table.file,
          "two rows or more in the judged part, --from-h to --to-h after the record's begin "
          "(report.record_from_h)");
  requireNoHole(table, hours, first + 1, judged.rows.back(), sample);
  return judged;
}

}  // namespace fpc
