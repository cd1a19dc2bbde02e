#include "tool/time_column.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/order_statistics.hpp"
#include "base/time_cells.hpp"
#include "base/time_unit.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;

constexpr double kEven = 0.02;    // of the spacing: steps that count as equal, since files round
constexpr double kJitter = 0.25;  // of the spacing: a row is still the sample that it is nearest to
constexpr double kTold = 0.005;   // jitter below it is rounding
constexpr double kRound = 1e-4;   // of the spacing: a rounder number as near as this is meant
constexpr double kMostSteps = 1e6;  // in one hole
constexpr double kUsual = 0.9;      // share of the steps that are one sample

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

std::vector<double> stepsOf(const Eigen::Ref<const Vector>& times) {
  std::vector<double> steps;
  for (Index k = 1; k < times.size(); ++k)
    if (std::isfinite(times[k] - times[k - 1])) steps.push_back(times[k] - times[k - 1]);
  return steps;
}

/// The number with the fewest digits within kRound of it.
double rounded(double step) {
  for (int digits = 1; digits < 8; ++digits) {
    const double unit = std::pow(10.0, std::floor(std::log10(step)) + 1.0 - digits);
    const double round = std::round(step / unit) * unit;
    if (std::abs(round - step) < kRound * step) return std::round(round * 1e12) / 1e12;
  }
  return step;
}

struct Spacing {
  double step{};    ///< 0: none
  double jitter{};  ///< largest distance of a step from a whole number of samples [samples]
};

/// The usual step of a column that rises evenly, but for rows that are missing and jitter.
Spacing spacingOf(const Eigen::Ref<const Vector>& times) {
  const std::vector<double> steps = stepsOf(times);
  const double usual = upperMedian(steps);
  if (!(usual > 0.0)) return {};
  Spacing s{usual, 0.0};
  double single = 0.0, sum = 0.0, samples = 0.0;
  for (const double step : steps) {
    const double whole = std::round(step / usual), off = std::abs(step / usual - whole);
    if (whole == 1.0 && off < kJitter) single += 1.0;
    if (whole < 1.0 || whole > kMostSteps || off >= kJitter) continue;
    s.jitter = std::max(s.jitter, off);
    sum += step;
    samples += whole;
  }
  if (!(single > kUsual * static_cast<double>(steps.size()))) return {};
  s.step = sum / samples;
  return s;
}

bool hasEnding(const std::string& name, const std::vector<std::string>& endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](const std::string& e) { return name == "t_" + e; });
}

bool isCalledTime(const std::string& name) {
  return name == "t" || name == "time" || name == "Time" || name.rfind("time_", 0) == 0 ||
         hasEnding(name, timeUnits());
}

/// Every step goes the same way: no measurement does that.
bool alwaysRisesOrFalls(const Eigen::Ref<const Vector>& times) {
  const std::vector<double> steps = stepsOf(times);
  const auto rises = [](double step) { return step > 0.0; };
  const auto falls = [](double step) { return step < 0.0; };
  return !steps.empty() && (std::all_of(steps.begin(), steps.end(), rises) ||
                            std::all_of(steps.begin(), steps.end(), falls));
}

std::string found(const CsvTable& table, const std::vector<std::string>& used) {
  for (const auto& name : table.names) {
    if (std::find(used.begin(), used.end(), name) != used.end()) continue;
    if (isCalledTime(name)) return name;
    if (name.rfind("t_", 0) == 0 && alwaysRisesOrFalls(table.values.col(table.column(name))))
      return name;
  }
  return "";
}

void requireRising(const CsvTable& table, const std::string& name, const Spacing& spacing) {
  if (spacing.step > 0.0) return;
  const double usual = upperMedian(stepsOf(table.values.col(table.column(name))));
  const std::string where = table.file + ": column '" + name + "'";
  require(!(usual < 0.0), where, "times that rise evenly; they fall (is the newest row first?)");
  throw InputError(where +
                   ": expected times that rise evenly, steps within a quarter of their median "
                   "(or of whole multiples, where rows are missing); resample the record");
}

}  // namespace

void requireNoClock(const CsvTable& table, const std::vector<std::string>& used) {
  for (const auto& name : used)
    require(!(isCalledTime(name) && alwaysRisesOrFalls(table.values.col(table.column(name)))),
            table.file + ": column '" + name + "'", "a signal, not the times");
}

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
  requirePlainTimes(table, column);
  const Spacing spacing = spacingOf(table.values.col(column));
  requireRising(table, time.name, spacing);
  time.unit = timeUnit(table, column);
  const std::string& given = table.units[static_cast<std::size_t>(column)];
  require(!time.unit.empty() || given.empty(), table.file + ": column '" + time.name + "'",
          "a unit [s], [min], [h] or [d], got [" + given + "]");
  time.step_s = rounded(spacing.step * (time.unit.empty() ? 1.0 : secondsPer(time.unit)));
  return time;
}

CsvTable withEvenTimes(CsvTable table, const std::string& name, std::vector<std::string>& remarks) {
  if (name.empty()) return table;
  auto times = table.values.col(table.column(name));
  const Spacing spacing = spacingOf(times);
  if (!(spacing.step > 0.0) || spacing.jitter < kTold) return table;
  Vector even = times;
  for (Index k = 1; k < times.size(); ++k) {
    const double step = (times[k] - times[k - 1]) / spacing.step, whole = std::round(step);
    if (!(whole >= 1.0 && std::abs(step - whole) < kJitter)) return table;  // told where it is read
    even[k] = even[k - 1] + whole * spacing.step;
  }
  times = even;
  char text[64];
  std::snprintf(text, sizeof text, "%.2g %% of the spacing", 100.0 * spacing.jitter);
  remarks.push_back("times of '" + name + "' jitter by up to " + text +
                    ": each row is taken as the sample that it is nearest to, all equally spaced");
  return table;
}

}  // namespace fpc::tool
