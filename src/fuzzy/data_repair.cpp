#include "fuzzy/data_repair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
constexpr double kSpacingTolerance = 0.02;  // of a sample: files round their times
constexpr double kLongestGap = 1e6;         // samples in one hole

double secondsPer(const std::string& unit) {
  static const std::map<std::string, double> seconds{
      {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}};
  return seconds.at(unit);
}

std::string rowText(Index first, Index row) { return "row " + std::to_string(first + row + 1); }

/// Order of the rows by time. @throws InputError if they are not sorted and may not be.
std::vector<Index> timeOrder(const Vector& time, const std::string& where, Index first,
                             bool may_sort, Index& moved) {
  std::vector<Index> order(static_cast<std::size_t>(time.size()));
  std::iota(order.begin(), order.end(), Index{0});
  moved = 0;
  for (Index k = 0; k < time.size(); ++k) {
    require(std::isfinite(time[k]), where, "a time in " + rowText(first, k));
    require(
        k == 0 || may_sort || time[k] > time[k - 1], where,
        "times that increase; " + rowText(first, k) + " does not (repair.sort_time: true sorts)");
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return time[a] < time[b]; });
  for (Index k = 0; k < time.size(); ++k) moved += order[static_cast<std::size_t>(k)] != k ? 1 : 0;
  return order;
}

/// Sample number of each row after the first. @throws InputError unless all are whole numbers of
/// samples apart.
std::vector<Index> sampleNumbers(const Vector& time, const std::vector<Index>& order, double sample,
                                 const std::string& where, Index first) {
  std::vector<Index> numbers{0};
  for (std::size_t k = 1; k < order.size(); ++k) {
    const double step = (time[order[k]] - time[order[k - 1]]) / sample;
    const double whole = std::round(step);
    if (whole < 1.0 || whole > kLongestGap || std::abs(step - whole) > kSpacingTolerance)
      throw InputError(where + ": expected times " + exactText(sample) +
                       " apart (sample_time_s; or another unit?), got " +
                       exactText(time[order[k]] - time[order[k - 1]]) + " before " +
                       rowText(first, order[k]));
    numbers.push_back(numbers.back() + static_cast<Index>(whole));
  }
  const Index holes = numbers.back() + 1 - static_cast<Index>(order.size());
  require(holes <= static_cast<Index>(order.size()), where,
          "times " + exactText(sample) +
              " apart (sample_time_s; or another unit?), got more holes than rows");
  return numbers;
}

std::vector<Index> missingRows(const Matrix& values, Index column) {
  std::vector<Index> rows;
  for (Index k = 0; k < values.rows(); ++k)
    if (std::isnan(values(k, column))) rows.push_back(k);
  return rows;
}

/// Straight lines over the holes; the nearest value at the ends.
void interpolate(Eigen::Ref<Vector> values) {
  Index before = -1;
  for (Index k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) continue;
    for (Index i = before + 1; i < k; ++i) {
      const double share =
          before < 0 ? 1.0 : static_cast<double>(i - before) / static_cast<double>(k - before);
      values[i] = before < 0 ? values[k] : values[before] + share * (values[k] - values[before]);
    }
    before = k;
  }
  for (Index i = before + 1; i < values.size(); ++i) values[i] = values[before];
}

}  // namespace

void repairTime(DataSet& data, const CsvTable& table, const Structure& structure, Index first,
                Index count) {
  const Index column = table.column(structure.time_column);
  const std::string where = table.file + ": column '" + structure.time_column + "'";
  const std::string& unit = table.units[static_cast<std::size_t>(column)];
  require(unit.empty() || unit == structure.time_unit, where,
          "the unit [" + structure.time_unit + "] of the structure, got [" + unit + "]");
  const Vector time = table.values.col(column).segment(first, count);
  Index moved = 0;
  const auto order = timeOrder(time, where, first, structure.repair.sort_time, moved);
  const auto numbers = sampleNumbers(
      time, order, structure.sample_time_s / secondsPer(structure.time_unit), where, first);
  const Index holes = numbers.back() + 1 - count;
  if (moved == 0 && holes == 0) return;
  Matrix placed = Matrix::Constant(numbers.back() + 1, data.values.cols(), kMissing);
  for (std::size_t k = 0; k < order.size(); ++k) placed.row(numbers[k]) = data.values.row(order[k]);
  data.values = placed;
  if (moved > 0) data.repairs.push_back(std::to_string(moved) + " rows moved to sort the times");
  if (holes > 0)
    data.repairs.push_back(std::to_string(holes) +
                           " rows absent from the times: treated as missing cells");
}

void holdLastInputs(DataSet& data) {
  const Index last = data.values.rows() - 1;
  if (last < 1) return;
  for (auto c = static_cast<Index>(data.outputs.size()); c < data.values.cols(); ++c)
    if (std::isnan(data.values(last, c))) data.values(last, c) = data.values(last - 1, c);
}

void repairMissing(DataSet& data, MissingCells how, const std::vector<std::string>& columns) {
  for (Index c = 0; c < data.values.cols(); ++c) {
    const std::string& column = columns[static_cast<std::size_t>(c)];
    const std::string where = data.source + ": column '" + column + "'";
    for (Index k = 0; k < data.values.rows(); ++k)
      require(!std::isinf(data.values(k, c)), where, "finite values");
    const auto rows = missingRows(data.values, c);
    if (rows.empty()) continue;
    require(static_cast<Index>(rows.size()) < data.values.rows(), where, "at least one number");
    require(how != MissingCells::kError, where,
            "no missing cells; " + std::to_string(rows.size()) + " are, the first in data row " +
                std::to_string(rows.front() + 1) + " (repair.missing: drop or interpolate)");
    const bool fill = how == MissingCells::kInterpolate;
    if (fill) interpolate(data.values.col(c));
    data.repairs.push_back(std::to_string(rows.size()) + " missing cells of '" + column +
                           (fill ? "' interpolated" : "' left out"));
  }
}

}  // namespace fpc
