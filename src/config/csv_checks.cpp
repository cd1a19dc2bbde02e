#include "config/csv_checks.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/csv_header.hpp"
#include "config/extending_loop.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

const Quantity* find(const std::vector<Quantity>& quantities, const std::string& name) {
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [&](const Quantity& q) { return q.name == name; });
  return found == quantities.end() ? nullptr : &*found;
}

std::string channelKey(const CsvChannel& channel) {
  return "disturbance.csv.channels." + channel.name;
}

std::vector<std::string> filesOf(const CsvDisturbanceParams& params) {
  std::vector<std::string> files{params.file};
  if (!params.next_file.empty()) files.push_back(params.next_file);
  return files;
}

/// Without what is only spelling: m^3/h, "m³ / h", degC and °C.
std::string plainUnit(std::string unit) {
  const std::pair<const char*, const char*> spellings[] = {
      {"\u00b3", "3"}, {"\u00b2", "2"}, {"\u00b0", "deg"}, {"\u00b5", "u"}, {"\u03bc", "u"},
      {"\u00b7", ""},  {"^", ""},       {"*", ""},         {" ", ""}};
  for (const auto& [from, to] : spellings)
    for (auto at = unit.find(from); at != std::string::npos; at = unit.find(from))
      unit.replace(at, std::string(from).size(), to);
  return unit;
}

/// Asked of the text: a scale of 1 that somebody wrote is an answer, that of the default is none.
bool isConverted(const LoopFile& loop, const CsvChannel& channel) {
  for (const char* how : {".scale", ".offset", ".mean"})
    if (!scalarOf(loop.resolved, channelKey(channel) + how).empty()) return true;
  return false;
}

/// The cell that leads farthest out of the range.
struct Culprit {
  std::string place;
  double cell{};
};

/// The lowest or highest cell of the channel's column in all files.
std::optional<Culprit> extremeCell(const CsvDisturbanceParams& params, const CsvChannel& channel,
                                   bool lowest) {
  std::optional<Culprit> culprit;
  for (const std::string& file : filesOf(params)) {
    const CsvTable table = readCsv(file, params.format);
    const Eigen::Index column = table.column(channel.column);
    for (Eigen::Index r = 0; r < table.rows(); ++r) {
      const double cell = table.values(r, column);
      const bool beyond = !culprit || (lowest ? cell < culprit->cell : cell > culprit->cell);
      if (!std::isnan(cell) && beyond) culprit = {table.at(r, column), cell};
    }
  }
  return culprit;
}

void checkChannel(const CsvDisturbanceParams& params, const CsvChannel& channel, const Quantity& q,
                  double least, double most) {
  const bool below = least < q.lower;
  if (!below && most <= q.upper) return;
  const auto culprit = extremeCell(params, channel, below == (channel.scale > 0.0));
  if (!culprit) return;
  const std::string cell = exactText(culprit->cell);
  throw InputError(culprit->place + ": expected a cell that makes " + q.name +
                   " >= " + exactText(q.lower) + " and <= " + exactText(q.upper) + " [" + q.unit +
                   "], the plant's range, got " + cell + " (a code for missing cells? " +
                   "disturbance.csv.missing_values: [" + cell + "]; a bad one? " +
                   channelKey(channel) + ".plausible)");
}

}  // namespace

void checkCsvUnits(const LoopFile& loop, const std::vector<Quantity>& disturbances) {
  const CsvDisturbanceParams& params = loop.disturbance.csv;
  for (const std::string& file : filesOf(params)) {
    const CsvTable header = readCsvHeader(file, params.format);
    for (const CsvChannel& channel : params.channels) {
      const Quantity* q = find(disturbances, channel.name);
      const auto column = static_cast<std::size_t>(header.column(channel.column));
      const std::string& stated = header.units[column];
      if (!q || stated.empty() || q->unit.empty() || q->unit == "-") continue;
      require(plainUnit(stated) == plainUnit(q->unit) || isConverted(loop, channel),
              file + ":1: column '" + channel.column + "'",
              "[" + q->unit + "], the unit of " + channel.name + ", got [" + stated + "]; with " +
                  channelKey(channel) +
                  ".scale, offset or mean another unit is converted (scale 1: the same by another "
                  "name)");
    }
  }
}

void checkCsvRanges(const CsvDisturbanceParams& params, const std::vector<Quantity>& disturbances,
                    const Matrix& values) {
  for (const CsvChannel& channel : params.channels)
    for (std::size_t i = 0; i < disturbances.size(); ++i) {
      if (disturbances[i].name != channel.name) continue;
      const auto row = values.row(static_cast<Eigen::Index>(i));
      checkChannel(params, channel, disturbances[i], row.minCoeff(), row.maxCoeff());
    }
}

}  // namespace fpc
