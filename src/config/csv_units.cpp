#include "config/csv_units.hpp"

#include <algorithm>
#include <fstream>

#include "base/csv_header.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/extending_loop.hpp"

namespace fpc {
namespace {

/// m^3/d and mg/L are m3/d and mg/l.
std::string plainUnit(std::string unit) {
  unit.erase(std::remove_if(unit.begin(), unit.end(), [](char c) { return c == ' ' || c == '^'; }),
             unit.end());
  std::replace(unit.begin(), unit.end(), 'L', 'l');
  return unit;
}

bool isConverted(const LoopFile& loop, const std::string& key) {
  for (const char* how : {".scale", ".offset", ".mean"})
    if (!scalarOf(loop.resolved, key + how).empty()) return true;
  return false;
}

void requireUnitsIn(const std::string& file, const LoopFile& loop,
                    const std::vector<Quantity>& disturbances) {
  std::ifstream stream(file);
  if (!stream.good()) return;  // whoever needs the rows says so
  const CsvTable header = readCsvHeader(stream, file, loop.disturbance.csv.format);
  for (const CsvChannel& channel : loop.disturbance.csv.channels) {
    const std::string& said = header.units[static_cast<std::size_t>(header.column(channel.column))];
    const auto own =
        std::find_if(disturbances.begin(), disturbances.end(),
                     [&](const Quantity& quantity) { return quantity.name == channel.name; });
    if (said.empty() || own == disturbances.end() || own->unit.empty()) continue;
    if (plainUnit(said) == plainUnit(own->unit)) continue;
    const std::string key = "disturbance.csv.channels." + channel.name;
    require(isConverted(loop, key), file + ": column '" + channel.column + "'",
            "the unit of " + channel.name + ", [" + own->unit + "], or " + key +
                ".scale, offset or mean to convert it; got [" + said + "]");
  }
}

}  // namespace

void requireCsvUnits(const LoopFile& loop, const std::vector<Quantity>& disturbances) {
  const CsvDisturbanceParams& csv = loop.disturbance.csv;
  requireUnitsIn(csv.file, loop, disturbances);
  if (!csv.next_file.empty()) requireUnitsIn(csv.next_file, loop, disturbances);
}

}  // namespace fpc
