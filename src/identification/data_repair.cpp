#include "identification/data_repair.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "base/csv_cell.hpp"
#include "base/time_cells.hpp"
#include "base/time_unit.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kSpacingTolerance = 0.02;  // of a sample: files round their times
constexpr double kLongestGap = 1e6;         // samples in one hole
constexpr double kLargestCell = 1e60;       // products of a few of them must stay finite

using RowName = std::function<std::string(Index row)>;

/// Order of the rows by time. @throws InputError if they are not sorted and may not be.
std::vector<Index> timeOrder(const Vector& time, const RowName& where, bool may_sort,
                             Index& moved) {
  std::vector<Index> order(static_cast<std::size_t>(time.size()));
  std::iota(order.begin(), order.end(), Index{0});
  moved = 0;
  for (Index k = 0; k < time.size(); ++k) {
    require(std::isfinite(time[k]), where(k), "a time");
    require(k == 0 || time[k] != time[k - 1], where(k), "every time only once");
    require(k == 0 || may_sort || time[k] > time[k - 1], where(k),
            "times that increase (a structure file's repair.sort_time: true sorts)");
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return time[a] < time[b]; });
  for (Index k = 0; k < time.size(); ++k) moved += order[static_cast<std::size_t>(k)] != k ? 1 : 0;
  return order;
}

/// The largest number of samples of which all rows lie whole multiples apart; 1 for a few rows.
Index commonStep(const std::vector<Index>& numbers) {
  if (numbers.size() < 3) return 1;
  Index common = 0;
  for (const Index number : numbers) common = std::gcd(common, number);
  return std::max<Index>(common, 1);
}

/// Sample number of each row after the first. @throws InputError unless all are whole numbers of
/// samples apart.
std::vector<Index> sampleNumbers(const Vector& time, const std::vector<Index>& order, double sample,
                                 const RowName& where) {
  std::vector<Index> numbers{0};
  for (std::size_t k = 1; k < order.size(); ++k) {
    const double step = (time[order[k]] - time[order[k - 1]]) / sample;
    const double whole = std::round(step);
    require(step != 0.0, where(order[k]), "every time only once");
    if (whole < 1.0 || whole > kLongestGap || std::abs(step - whole) > kSpacingTolerance)
      throw InputError(where(order[k]) + ": expected times " + exactText(sample) +
                       " apart (sample_time_s; or another unit?), got " +
                       exactText(time[order[k]] - time[order[k - 1]]));
    numbers.push_back(numbers.back() + static_cast<Index>(whole));
  }
  return numbers;
}

}  // namespace

TableRows repairTime(DataSet& data, const CsvTable& table, const Structure& structure, Index first,
                     Index count) {
  const Index column = table.column(structure.time_column);
  const auto index = static_cast<std::size_t>(column);
  const bool dates = index < table.is_date.size() && table.is_date[index];
  const std::string unit_expected = dates ? "d" : structure.time_unit;
  const std::string& unit = table.units[index];
  const auto where = [&](Index row) { return table.at(first + row, column); };
  requirePlainTimes(table, column);
  require(unit.empty() || unit == unit_expected,
          table.file + ": column '" + structure.time_column + "'",
          "the unit [" + unit_expected + "] of the structure, got [" + unit + "]");
  const std::string text = index < table.texts.size() ? table.texts[index] : "";
  require(text.empty(), where(0),
          "numbers, YYYY-MM-DD or YYYY-MM-DDThh:mm:ss, got '" + text + "'" + decimalHint(text));
  const Vector time = table.values.col(column).segment(first, count);
  const double sample = structure.sample_time_s / secondsPer(unit_expected);
  Index moved = 0;
  const auto order = timeOrder(time, where, structure.repair.sort_time, moved);
  const auto numbers = sampleNumbers(time, order, sample, where);
  const Index common = commonStep(numbers);
  require(common == 1 || structure.repair.missing != MissingCells::kError, where(0),
          "times " + exactText(sample) + " apart (another unit? or another sample_time_s), got " +
              exactText(static_cast<double>(common) * sample) +
              " from each row to the next, or multiples of it");
  const Index holes = numbers.back() + 1 - count;
  require(holes <= count, where(order.back()),
          "times " + exactText(sample) +
              " apart (sample_time_s; or another unit?), got more holes than rows");
  TableRows rows(static_cast<std::size_t>(numbers.back()) + 1, -1);
  Matrix placed = Matrix::Constant(numbers.back() + 1, data.values.cols(), kNaN);
  for (std::size_t k = 0; k < order.size(); ++k) {
    placed.row(numbers[k]) = data.values.row(order[k]);
    rows[static_cast<std::size_t>(numbers[k])] = first + order[k];
  }
  data.values = placed;
  if (moved > 0) data.repairs.push_back(std::to_string(moved) + " rows moved to sort the times");
  if (holes > 0)
    data.repairs.push_back(std::to_string(holes) +
                           " rows absent from the times: treated as missing cells");
  return rows;
}

void holdLastInputs(DataSet& data) {
  const Index last = data.values.rows() - 1;
  if (last < 1) return;
  for (auto c = static_cast<Index>(data.outputs.size()); c < data.values.cols(); ++c)
    if (std::isnan(data.values(last, c))) data.values(last, c) = data.values(last - 1, c);
}

namespace {

std::string wordsFor(MissingCells how) {
  if (how == MissingCells::kDrop) return "left out";
  return how == MissingCells::kHold ? "held" : "interpolated";
}

std::string wordsFor(Implausible how) {
  if (how == Implausible::kDrop) return "left out";
  if (how == Implausible::kClip) return "clipped";
  return how == Implausible::kHold ? "held" : "interpolated";
}

ColumnRules rulesOf(const Structure& structure, const StructureSignal& signal) {
  return {structure.repair.missing, signal.info.lower, signal.info.upper, signal.implausible,
          signal.info.unit,         "repair.missing",  "implausible"};
}

}  // namespace

void repairCells(DataSet& data, const Structure& structure,
                 const std::vector<StructureSignal>& signals, const CellName& where) {
  std::vector<double> times(static_cast<std::size_t>(data.values.rows()));
  std::iota(times.begin(), times.end(), 0.0);
  for (Index c = 0; c < data.values.cols(); ++c) {
    const StructureSignal& signal = signals[static_cast<std::size_t>(c)];
    const auto at = [&](Index row) { return where(c, row); };
    for (Index k = 0; k < data.values.rows(); ++k)
      require(!std::isinf(data.values(k, c)), at(k), "finite values");
    const ColumnRepairs done =
        repairColumn(data.values.col(c), times, rulesOf(structure, signal), at);
    for (Index k = 0; k < data.values.rows(); ++k)
      require(!(std::abs(data.values(k, c)) > kLargestCell), at(k),
              "values of at most 1e60 (a code for missing cells? csv.missing_values of a structure "
              "file, --missing), got " +
                  exactText(data.values(k, c)));
    const std::string of = " cells of '" + signal.column + "' ";
    if (done.missing > 0)
      data.repairs.push_back(std::to_string(done.missing) + " missing" + of +
                             wordsFor(structure.repair.missing));
    if (done.implausible > 0)
      data.repairs.push_back(std::to_string(done.implausible) + " implausible" + of +
                             wordsFor(signal.implausible));
  }
}

}  // namespace fpc
