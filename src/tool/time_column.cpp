#include "tool/time_column.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/time_unit.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;

constexpr double kEven = 0.02;  // of the spacing: steps that count as equal, since files round

/// s, min, h or d by the unit in the header, or the ending of the name; empty: neither tells.
std::string timeUnit(const CsvTable& table, Index column) {
  const auto i = static_cast<std::size_t>(column);
  for (const std::string& unit : timeUnits()) {
    const std::string ending = "_" + unit, &name = table.names[i];
    if (table.units[i] == unit) return unit;
    if (name.size() > ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
      return unit;
  }
  if (i < table.is_date.size() && table.is_date[i]) return "d";
  return "";
}

/// The usual step of a rising column; 0 if it does not rise evenly.
double evenStep(const Eigen::Ref<const Vector>& times) {
  std::vector<double> steps;
  for (Index k = 1; k < times.size(); ++k)
    if (std::isfinite(times[k] - times[k - 1])) steps.push_back(times[k] - times[k - 1]);
  if (steps.empty()) return 0.0;
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2),
                   steps.end());
  const double usual = steps[steps.size() / 2];
  if (!(usual > 0.0)) return 0.0;
  const auto even = std::count_if(steps.begin(), steps.end(), [usual](double s) {
    return std::abs(s - usual) < kEven * usual;
  });
  return static_cast<double>(even) > 0.9 * static_cast<double>(steps.size()) ? usual : 0.0;
}

bool isCalledTime(const std::string& name) {
  return name == "t" || name == "time" || name == "Time" || name.rfind("time_", 0) == 0;
}

std::string found(const CsvTable& table, const std::vector<std::string>& used) {
  for (const auto& name : table.names) {
    if (std::find(used.begin(), used.end(), name) != used.end()) continue;
    if (isCalledTime(name)) return name;
    if (name.rfind("t_", 0) == 0 && evenStep(table.values.col(table.column(name))) > 0.0)
      return name;
  }
  return "";
}

}  // namespace

void TimeColumn::fitTo(double sample_time_s) {
  if (!unit.empty()) return;
  for (const std::string& guess : timeUnits())
    if (std::abs(step_s * secondsPer(guess) - sample_time_s) < kEven * sample_time_s) unit = guess;
}

TimeColumn timeColumn(const CsvTable& table, const std::string& named,
                      const std::vector<std::string>& used) {
  TimeColumn time;
  time.name = named.empty() ? found(table, used) : named;
  if (time.name.empty()) return time;
  const Index column = table.column(time.name);
  const double step = evenStep(table.values.col(column));
  require(step > 0.0, table.file + ": column '" + time.name + "'", "times that rise evenly");
  time.unit = timeUnit(table, column);
  const std::string& given = table.units[static_cast<std::size_t>(column)];
  require(!time.unit.empty() || given.empty(), table.file + ": column '" + time.name + "'",
          "a unit [s], [min], [h] or [d], got [" + given + "]");
  time.step_s = step * (time.unit.empty() ? 1.0 : secondsPer(time.unit));
  return time;
}

}  // namespace fpc::tool
