// A user's own record as the disturbance: columns by name, any time unit, missing cells repaired as
// asked.
#include <algorithm>
#include <cmath>
#include <map>

#include "fmbpc/base/csv.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/plant/disturbance.hpp"

namespace fpc {
namespace {

/// Files round their times (0.010416667 d for 900 s): a row counts from this part of an interval
/// before its time.
constexpr double kEarly = 1e-4;

void requireOneOf(const std::string& value, const std::vector<std::string>& choices,
                  const std::string& key) {
  require(std::find(choices.begin(), choices.end(), value) != choices.end(), key,
          "one of " + join(choices) + ", got '" + value + "'");
}

double secondsOf(const std::string& unit) {
  static const std::map<std::string, double> units = {
      {"s", 1.0}, {"min", 60.0}, {"h", 3600.0}, {"d", 86400.0}};
  const auto found = units.find(unit);
  require(found != units.end(), "disturbance.time_unit", "one of s, min, h, d, got '" + unit + "'");
  return found->second;
}

std::string at(const CsvTable& table, const std::string& column) {
  return table.file + ": column '" + column + "'";
}

/// Seconds since the first row.
std::vector<double> timesOf(const CsvTable& table, const CsvDisturbanceParams& params) {
  const Eigen::Index column = table.column(params.time_column);
  const std::string where = at(table, params.time_column);
  require(!table.is_date[static_cast<std::size_t>(column)] || params.time_unit == "d", where,
          "disturbance.time_unit d, since it holds dates");
  const double unit_s = secondsOf(params.time_unit);
  const auto& cells = table.values.col(column);
  std::vector<double> times;
  for (Eigen::Index r = 0; r < table.rows(); ++r) {
    const std::string row = where + ", row " + std::to_string(r + 1);
    require(!std::isnan(cells[r]), row, "a time, the cell is missing");
    const double time = (cells[r] - cells[0]) * unit_s;
    require(times.empty() || time > times.back(), row,
            "increasing times, got " + exactText(cells[r]) + " after " +
                exactText(cells[std::max<Eigen::Index>(r - 1, 0)]));
    times.push_back(time);
  }
  require(times.size() >= 2, where, "at least two rows");
  return times;
}

Eigen::Index nextMeasured(const Vector& cells, Eigen::Index from) {
  while (from < cells.size() && std::isnan(cells[from])) ++from;
  return from;
}

/// Fills missing cells; at the ends the nearest measured cell stands for them. Returns how many
/// there were.
std::uint64_t repair(Vector& cells, const std::vector<double>& times, bool interpolate) {
  std::uint64_t count = 0;
  for (Eigen::Index r = 0; r < cells.size(); ++r) {
    if (!std::isnan(cells[r])) continue;
    ++count;
    const Eigen::Index next = nextMeasured(cells, r);
    const bool has_next = next < cells.size();
    if (r == 0 || (interpolate && !has_next)) {
      cells[r] = cells[r == 0 ? next : r - 1];
    } else if (!interpolate) {
      cells[r] = cells[r - 1];
    } else {
      const auto t = [&](Eigen::Index i) { return times[static_cast<std::size_t>(i)]; };
      const double part = (t(r) - t(r - 1)) / (t(next) - t(r - 1));
      cells[r] = cells[r - 1] + part * (cells[next] - cells[r - 1]);
    }
  }
  return count;
}

/// One channel on the rows of the file.
Vector channelValues(const CsvTable& table, const CsvChannel& channel, const std::string& missing,
                     const std::vector<double>& times, std::uint64_t& repaired) {
  const Eigen::Index column = table.column(channel.column);
  const std::string where = at(table, channel.column);
  Vector cells = table.values.col(column);
  require(!table.is_date[static_cast<std::size_t>(column)], where, "numbers, not dates");
  const Eigen::Index first_missing = (cells.array().isNaN()).count() == 0 ? -1 : [&] {
    Eigen::Index r = 0;
    while (!std::isnan(cells[r])) ++r;
    return r;
  }();
  require(nextMeasured(cells, 0) < cells.size(), where, "at least one number");
  require(first_missing < 0 || missing != "error",
          where + ", row " + std::to_string(first_missing + 1),
          "no missing cells, or disturbance.missing hold or interpolate");
  double scale = channel.scale, offset = channel.offset;
  if (channel.mean != 0.0) {
    const double mean = cells.array().isNaN().select(0.0, cells.array()).sum() /
                        static_cast<double>(cells.size() - table.missing(column));
    require(mean != 0.0, where, "a mean other than 0 to be scaled to " + exactText(channel.mean));
    scale = channel.mean / mean;
    offset = 0.0;
  }
  repaired += repair(cells, times, missing == "interpolate");
  return (scale * cells.array() + offset).matrix();
}

/// The channels on the file's rows, and where a time falls among them.
struct Record {
  std::vector<double> times;  ///< [s], first 0; the last one is the end
  Matrix values;              ///< n_d x times.size(); the last column is what follows the end
  double length() const { return times.back(); }
};

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
    while (params.end == "repeat" && t >= record.length() - slack) {
      passed += record.length();
      t -= record.length();
      row = 0;
    }
    values.col(k) = valuesAt(record, t, params.interpolation == "linear", row);
  }
  return values;
}

void validate(const CsvDisturbanceParams& params, std::uint32_t samples, double sample_time_s) {
  requireOneOf(params.missing, {"error", "hold", "interpolate"}, "disturbance.missing");
  requireOneOf(params.interpolation, {"hold", "linear"}, "disturbance.interpolation");
  requireOneOf(params.end, {"error", "hold", "repeat"}, "disturbance.end");
  require(samples > 0, "disturbance: csv", "a run with a duration");
  require(sample_time_s > 0.0 && std::isfinite(sample_time_s), "sampling.sample_time_s",
          "a finite number > 0");
  for (const auto& channel : params.channels)
    require(std::isfinite(channel.scale) && std::isfinite(channel.offset) &&
                std::isfinite(channel.mean),
            "disturbance: channel '" + channel.name + "'", "finite scale, offset and mean");
}

}  // namespace

DisturbanceRecord readDisturbances(const CsvDisturbanceParams& params,
                                   const std::vector<std::string>& names, const Vector& nominal,
                                   double sample_time_s, std::uint32_t samples) {
  validate(params, samples, sample_time_s);
  require(nominal.size() == static_cast<Eigen::Index>(names.size()), "disturbance.nominal",
          std::to_string(names.size()) + " numbers");
  const CsvTable table = readCsv(params.file);
  DisturbanceRecord result;
  Record record{timesOf(table, params), nominal.replicate(1, table.rows())};
  std::vector<bool> taken(names.size(), false);
  for (const auto& channel : params.channels) {
    const std::string where = "disturbance: channel '" + channel.name + "'";
    const auto found = std::find(names.begin(), names.end(), channel.name);
    require(found != names.end(), where, "one of " + join(names));
    const auto row = found - names.begin();
    require(!taken[static_cast<std::size_t>(row)], where, "every channel only once");
    taken[static_cast<std::size_t>(row)] = true;
    record.values.row(row) =
        channelValues(table, channel, params.missing, record.times, result.repaired).transpose();
  }
  close(record, params.end == "repeat");
  const double needed = samples * sample_time_s;
  require(params.end != "error" || needed <= record.length() * (1.0 + kEarly), table.file,
          "a record of at least " + exactText(needed / 3600.0) + " h, or disturbance.end hold or " +
              "repeat; it has " + exactText(record.length() / 3600.0) + " h");
  result.values = resampled(record, params, sample_time_s, static_cast<Eigen::Index>(samples) + 1);
  return result;
}

}  // namespace fpc
