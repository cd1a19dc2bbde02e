#include "tool/auto_structure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;

constexpr double kEqual = 1e-3;  // of the spacing: steps that count as equal

std::vector<StructureSignal> signalsOf(const CsvTable& table,
                                       const std::vector<std::string>& columns) {
  const double infinite = std::numeric_limits<double>::infinity();
  std::vector<StructureSignal> signals;
  for (const auto& column : columns) {
    const auto index = static_cast<std::size_t>(table.column(column));
    StructureSignal& signal = signals.emplace_back();
    signal.info = SignalInfo{signalName(column), table.units[index], -infinite, infinite};
    signal.column = column;
  }
  return signals;
}

/// s, min, h or d by the unit in the header, or the ending of the name; empty: neither tells.
std::string timeUnit(const CsvTable& table, Index column) {
  const auto i = static_cast<std::size_t>(column);
  for (const std::string unit : {"s", "min", "h", "d"}) {
    const std::string ending = "_" + unit, &name = table.names[i];
    if (table.units[i] == unit) return unit;
    if (name.size() > ending.size() &&
        name.compare(name.size() - ending.size(), ending.size(), ending) == 0)
      return unit;
  }
  if (i < table.is_date.size() && table.is_date[i]) return "d";
  return "";
}

double secondsOf(const std::string& unit) {
  return unit == "min" ? 60.0 : unit == "h" ? 3600.0 : unit == "d" ? 86400.0 : 1.0;
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
    return std::abs(s - usual) < std::max(kEqual, 0.02) * usual;
  });
  return static_cast<double>(even) > 0.9 * static_cast<double>(steps.size()) ? usual : 0.0;
}

bool looksLikeTime(const std::string& name) {
  return name == "t" || name == "time" || name == "Time" || name.rfind("t_", 0) == 0 ||
         name.rfind("time_", 0) == 0;
}

std::string findTime(const CsvTable& table, const AutoColumns& columns) {
  if (!columns.time.empty()) return columns.time;
  for (const auto& name : table.names) {
    const auto used = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    if (used(columns.outputs) || used(columns.inputs) || used(columns.disturbances)) continue;
    if (looksLikeTime(name) && evenStep(table.values.col(table.column(name))) > 0.0) return name;
  }
  return "";
}

void setSampleTime(const CsvTable& table, const AutoColumns& columns, Structure& structure,
                   std::vector<std::string>& remarks) {
  if (columns.sample_time_s > 0.0) {
    structure.sample_time_s = columns.sample_time_s;
    return;
  }
  const std::string time = findTime(table, columns);
  if (time.empty()) {
    structure.sample_time_s = 1.0;
    remarks.push_back("no time column found: sample time taken as 1 s (--time, --sample-time)");
    return;
  }
  const Index column = table.column(time);
  const double step = evenStep(table.values.col(column));
  require(step > 0.0, table.file + ": column '" + time + "'", "times that rise evenly");
  const std::string unit = timeUnit(table, column);
  if (unit.empty()) remarks.push_back("'" + time + "' is taken to be in seconds");
  structure.time_unit = unit.empty() ? "s" : unit;
  const double seconds = step * secondsOf(structure.time_unit);
  structure.sample_time_s = std::round(seconds * 1e6) / 1e6;
}

}  // namespace

std::string signalName(const std::string& column) {
  std::string name = column;
  for (char& c : name)
    if (c == ' ' || c == '\t' || c == '(' || c == ')') c = '_';
  return name;
}

Structure autoStructure(const CsvTable& table, const AutoColumns& columns,
                        std::vector<std::string>& remarks) {
  require(!columns.outputs.empty(), "--outputs", "at least one column of " + table.file);
  require(!columns.inputs.empty() || !columns.disturbances.empty(), "--inputs",
          "at least one column of " + table.file);
  Structure s;
  s.name = "auto";
  s.outputs = signalsOf(table, columns.outputs);
  s.inputs = signalsOf(table, columns.inputs);
  s.disturbances = signalsOf(table, columns.disturbances);
  setSampleTime(table, columns, s, remarks);
  s.repair.missing = MissingCells::kDrop;
  s.repair.drop_constant = true;
  for (std::size_t i = 0; i < s.outputs.size(); ++i) {
    OutputStructure part;
    part.regressors.push_back({SignalKind::kOutput, static_cast<int>(i), 0});
    part.antecedents = part.regressors;
    s.submodels.push_back(part);
  }
  s.validate();
  return s;
}

}  // namespace fpc::tool
