// A user's own record as the disturbance: columns by name, any time unit, missing cells repaired as
// asked.
#include <algorithm>
#include <cmath>

#include "base/csv.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/channel_rows.hpp"
#include "plant/csv_rows.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace {

/// Files round their times (0.010416667 d for 900 s): a row counts from this part of an interval
/// before its time.
constexpr double kEarly = 1e-4;

/// Of the cells that the file measured, after their repair.
double meanMeasured(const CsvTable& table, const CsvRows& rows, Eigen::Index column,
                    const Vector& cells) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index r = 0; r < cells.size(); ++r) {
    const Eigen::Index row = rows.of_table[static_cast<std::size_t>(r)];
    if (row < 0 || std::isnan(table.values(row, column))) continue;
    sum += cells[r];
    ++count;
  }
  return sum / count;
}

ColumnRules rulesOf(const CsvChannel& channel, MissingCells missing) {
  ColumnRules rules;
  rules.missing = missing;
  rules.lower = channel.lower;
  rules.upper = channel.upper;
  rules.implausible = missing == MissingCells::kHold          ? Implausible::kHold
                      : missing == MissingCells::kInterpolate ? Implausible::kInterpolate
                                                              : Implausible::kError;
  rules.missing_key = "disturbance.csv.missing";
  rules.implausible_key = "disturbance.csv.missing";
  return rules;
}

/// One channel on the completed rows.
Vector channelValues(const CsvTable& table, const CsvRows& rows, const CsvChannel& channel,
                     MissingCells missing, DisturbanceRecord& result) {
  const Eigen::Index column = table.column(channel.column);
  const std::string whole = table.file + ": column '" + channel.column + "'";
  require(!table.is_date[static_cast<std::size_t>(column)], whole, "numbers, not dates");
  Vector cells(static_cast<Eigen::Index>(rows.times.size()));
  for (Eigen::Index r = 0; r < cells.size(); ++r) {
    const Eigen::Index row = rows.of_table[static_cast<std::size_t>(r)];
    cells[r] = row < 0 ? std::numeric_limits<double>::quiet_NaN() : table.values(row, column);
  }
  const auto where = [&](Eigen::Index r) {
    const auto i = static_cast<std::size_t>(r);
    return table.at(rows.before[i], column) +
           (rows.of_table[i] < 0 ? ": the time jumps after this row" : "");
  };
  const std::string& text = table.texts[static_cast<std::size_t>(column)];
  require(!cells.array().isNaN().all(), whole,
          "at least one number" + (text.empty() ? "" : ", got '" + text + "'"));
  const ColumnRepairs repairs = repairColumn(cells, rows.times, rulesOf(channel, missing), where);
  result.repaired += repairs.missing;
  result.implausible += repairs.implausible;
  if (channel.mean == 0.0) return (channel.scale * cells.array() + channel.offset).matrix();
  const double mean = meanMeasured(table, rows, column, cells);
  require(mean != 0.0, whole, "a mean other than 0 to be scaled to " + exactText(channel.mean));
  return channel.mean / mean * cells;
}

/// The channels on the file's rows, and where a time falls among them.
struct Record {
  std::vector<double> times;  ///< [s], first 0; the last one is the end
  Matrix values;              ///< n_d x times.size(); the last column is what follows the end
  double length() const { return times.back(); }
};

constexpr double kLate = 0.02;  // of a sample: what files round

/// The rows of a file by their times, before the end is added.
LateRows lateOf(const CsvRows& rows, const CsvDisturbanceParams& params, double sample_time_s,
                std::uint32_t samples) {
  LateRows late;
  const bool held = params.interpolation == Interpolation::kHold;
  for (std::size_t r = 1; r < rows.times.size(); ++r) {
    const double t = rows.times[r];
    if (rows.of_table[r] < 0 || t >= samples * sample_time_s) continue;
    const double after = t - std::floor(t / sample_time_s) * sample_time_s;
    ++late.of;
    late.rows += held && after > kEarly * (t - rows.times[r - 1]) && after <= kLate * sample_time_s;
  }
  return late;
}

/// Adds the end: the last row acts as long as the one before it, or, if it repeats the first one,
/// just closes the period.
void close(Record& record, bool repeat) {
  const auto rows = record.values.cols();
  const double last = record.times.back() - record.times[record.times.size() - 2];
  const bool closed = repeat && record.values.col(0) == record.values.col(rows - 1);
  if (closed) return;
  record.times.push_back(record.times.back() + last);
  record.values.conservativeResize(Eigen::NoChange, rows + 1);
  record.values.col(rows) = record.values.col(repeat ? 0 : rows - 1);
}

/// Values at `t` in [0, length]; `row` moves forward from call to call.
Vector valuesAt(const Record& record, double t, bool linear, std::size_t& row) {
  const auto& times = record.times;
  const auto width = [&](std::size_t r) { return times[r + 1] - times[r]; };
  while (row + 2 < times.size() && t >= times[row + 1] - kEarly * width(row)) ++row;
  const auto column = static_cast<Eigen::Index>(row);
  if (!linear) return record.values.col(column);
  const double part = std::clamp((t - times[row]) / width(row), 0.0, 1.0);
  return record.values.col(column) +
         part * (record.values.col(column + 1) - record.values.col(column));
}

Matrix resampled(const Record& record, const CsvDisturbanceParams& params, double sample_time_s,
                 Eigen::Index columns) {
  Matrix values(record.values.rows(), columns);
  std::size_t row = 0;
  double passed = 0.0;
  for (Eigen::Index k = 0; k < columns; ++k) {
    double t = static_cast<double>(k) * sample_time_s - passed;
    const double slack = kEarly * sample_time_s;
    while (params.end == RecordEnd::kRepeat && t >= record.length() - slack) {
      passed += record.length();
      t -= record.length();
      row = 0;
    }
    values.col(k) = valuesAt(record, t, params.interpolation == Interpolation::kLinear, row);
  }
  return values;
}

void validate(const CsvDisturbanceParams& params, std::uint32_t samples, double sample_time_s) {
  require(params.missing != MissingCells::kDrop, "disturbance.csv.missing",
          "an error, or cells held or interpolated");
  params.format.validate();
  require(samples > 0, "disturbance: csv", "a run with a duration");
  require(sample_time_s > 0.0 && std::isfinite(sample_time_s), "sampling.sample_time_s",
          "a finite number > 0");
  for (const auto& channel : params.channels)
    require(std::isfinite(channel.scale) && std::isfinite(channel.offset) &&
                std::isfinite(channel.mean),
            channelName(channel.name), "finite scale, offset and mean");
  for (const auto& channel : params.channels)
    require(channel.lower <= channel.upper, channelName(channel.name),
            "plausible cells from lower to upper");
}

}  // namespace

DisturbanceRecord readDisturbances(const CsvDisturbanceParams& params,
                                   const std::vector<std::string>& names, const Vector& nominal,
                                   double sample_time_s, std::uint32_t samples) {
  validate(params, samples, sample_time_s);
  require(nominal.size() == static_cast<Eigen::Index>(names.size()), "disturbance.nominal",
          std::to_string(names.size()) + " numbers");
  const CsvTable table = readCsv(params.file, params.format);
  const CsvRows rows = csvRows(table, params.time_column, params.time_unit);
  DisturbanceRecord result;
  Record record{rows.times, nominal.replicate(1, static_cast<Eigen::Index>(rows.times.size()))};
  ChannelRows places(names);
  for (const auto& channel : params.channels) {
    const Eigen::Index row = places.take(channel.name);
    record.values.row(row) =
        channelValues(table, rows, channel, params.missing, result).transpose();
  }
  result.late = lateOf(rows, params, sample_time_s, samples);
  close(record, params.end == RecordEnd::kRepeat);
  const double needed = samples * sample_time_s;
  require(params.end != RecordEnd::kError || needed <= record.length() * (1.0 + kEarly), table.file,
          "a record of at least " + exactText(needed / 3600.0) +
              " h, or disturbance.csv.end hold or " + "repeat; it has " +
              exactText(record.length() / 3600.0) + " h");
  result.values = resampled(record, params, sample_time_s, static_cast<Eigen::Index>(samples) + 1);
  return result;
}

}  // namespace fpc
