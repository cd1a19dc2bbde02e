#include "tool/time_column.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

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
constexpr double kMostSteps = 1e6;    // in one hole
constexpr double kUsual = 0.9;        // share of the steps that are one sample
constexpr Index kShortestPiece = 30;  // rows between two jumps back

/// Letters and digits of a name in lower case, cut at all else: "time (s)" gives time, s.
std::vector<std::string> wordsOf(const std::string& name) {
  std::vector<std::string> words{""};
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0)
      words.back() += static_cast<char>(std::tolower(letter));
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// One of timeUnits() by itself or by a longer word; empty for another word.
std::string unitOf(const std::string& word) {
  static const std::map<std::string, std::string> longer{
      {"sec", "s"},      {"secs", "s"}, {"second", "s"}, {"seconds", "s"}, {"mins", "min"},
      {"minute", "min"}, {"hr", "h"},   {"hrs", "h"},    {"hour", "h"},    {"minutes", "min"},
      {"hours", "h"},    {"day", "d"},  {"days", "d"},   {"msec", "ms"},   {"milliseconds", "ms"}};
  if (secondsPer(word) > 0.0) return word;
  const auto found = longer.find(word);
  return found != longer.end() ? found->second : "";
}

/// By the unit in the header, or the last word of the name; empty: neither tells.
std::string timeUnit(const CsvTable& table, Index column) {
  const auto i = static_cast<std::size_t>(column);
  if (i < table.is_date.size() && table.is_date[i]) return "d";
  const std::string given = unitOf(table.units[i]);
  if (!given.empty()) return given;
  const auto words = wordsOf(table.names[i]);
  return words.empty() ? "" : unitOf(words.back());
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

/// Every step goes the same way: no measurement does that.
bool alwaysRisesOrFalls(const Eigen::Ref<const Vector>& times) {
  const std::vector<double> steps = stepsOf(times);
  const auto rises = [](double step) { return step > 0.0; };
  const auto falls = [](double step) { return step < 0.0; };
  return !steps.empty() && (std::all_of(steps.begin(), steps.end(), rises) ||
                            std::all_of(steps.begin(), steps.end(), falls));
}

/// T, sec, hours, .. may as well be a temperature or a duration: only if they always rise evenly.
bool mayBeTime(const CsvTable& table, const std::string& name) {
  const auto column = table.values.col(table.column(name));
  return alwaysRisesOrFalls(column) && spacingOf(column.cwiseAbs()).step > 0.0;
}

bool isCalledTime(const CsvTable& table, const std::string& name) {
  static const std::set<std::string> sure{"time", "times", "timestamp",  "datetime",
                                          "date", "dates", "timestamps", "zeit"};
  const auto words = wordsOf(name);
  if (words.empty()) return false;
  if (sure.count(words.front()) != 0 || name == "t") return true;
  const bool t = words.front() == "t" && (words.size() == 1 || name[0] == 't');
  if (t && words.size() == 2 && !unitOf(words.back()).empty()) return true;
  const bool unit = words.size() == 1 && !unitOf(words.front()).empty();
  return (unit || t) && mayBeTime(table, name);
}

bool isDate(const CsvTable& table, const std::string& name) {
  const auto i = static_cast<std::size_t>(table.column(name));
  return i < table.is_date.size() && table.is_date[i];
}

/// The first column that is called a time and rises evenly, or that holds such dates; else the
/// first that is called a time; empty: there is none.
std::string found(const CsvTable& table, const std::vector<std::string>& used) {
  std::string first;
  for (const auto& name : table.names) {
    if (std::find(used.begin(), used.end(), name) != used.end()) continue;
    if (!isCalledTime(table, name) && !isDate(table, name)) continue;
    if (spacingOf(table.values.col(table.column(name))).step > 0.0) return name;
    if (first.empty() && isCalledTime(table, name)) first = name;
  }
  return first;
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
    require(
        !(isCalledTime(table, name) && alwaysRisesOrFalls(table.values.col(table.column(name)))),
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
  const std::string& text =
      table.texts.empty() ? time.name : table.texts[static_cast<std::size_t>(column)];
  require(!table.values.col(column).array().isNaN().all(),
          table.file + ": column '" + time.name + "'",
          "times in s, min, h, d or ms, or dates of ISO 8601 or DD.MM.YYYY, got '" + text + "'");
  requirePlainTimes(table, column);
  const Spacing spacing = spacingOf(table.values.col(column));
  requireRising(table, time.name, spacing);
  time.unit = timeUnit(table, column);
  const std::string& given = table.units[static_cast<std::size_t>(column)];
  const auto words = wordsOf(time.name);
  const bool strange = !words.empty() && std::isdigit(static_cast<unsigned char>(words.back()[0]));
  require(!time.unit.empty() || (given.empty() && !strange),
          table.file + ": column '" + time.name + "'",
          "a unit [s], [min], [h], [d] or [ms] (or --sample-time), got [" +
              (given.empty() && strange ? words.back() : given) + "]");
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

std::vector<CsvTable> piecesOf(const CsvTable& table, const std::string& name,
                               std::vector<std::string>& remarks) {
  if (name.empty()) return {table};
  const auto times = table.values.col(table.column(name));
  std::vector<Index> starts{0};
  for (Index k = 1; k < times.size(); ++k)
    if (times[k] == times[k - 1])
      return {table};  // a time that comes twice is refused where it is read
    else if (times[k] < times[k - 1])
      starts.push_back(k);
  starts.push_back(times.size());
  for (std::size_t i = 0; i + 1 < starts.size(); ++i)
    if (starts.size() > 2 && starts[i + 1] - starts[i] < kShortestPiece)
      return {table};  // no pieces, but rows out of order: refused where they are read
  std::vector<CsvTable> pieces;
  for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
    CsvTable& piece = pieces.emplace_back(table);
    const auto first = starts[i], count = starts[i + 1] - first;
    piece.values = table.values.middleRows(first, count);
    if (!table.lines.empty())
      piece.lines = {table.lines.begin() + first, table.lines.begin() + first + count};
    if (i > 0)
      remarks.push_back("times of '" + name + "' jump back at " +
                        table.at(first, table.column(name)) +
                        ": the rows from there on are taken "
                        "as a record of their own");
  }
  return pieces;
}

}  // namespace fpc::tool
