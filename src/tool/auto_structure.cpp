#include "tool/auto_structure.hpp"

#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "tool/time_column.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;

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

void setSampleTime(const CsvTable& table, const AutoColumns& columns, Structure& structure,
                   std::vector<std::string>& remarks) {
  std::vector<std::string> used = columns.outputs;
  used.insert(used.end(), columns.inputs.begin(), columns.inputs.end());
  used.insert(used.end(), columns.disturbances.begin(), columns.disturbances.end());
  requireNoClock(table, used);
  if (columns.sample_time_s > 0.0) {
    structure.sample_time_s = columns.sample_time_s;
    return;
  }
  const TimeColumn time = timeColumn(table, columns.time, used);
  require(!time.name.empty(), table.file,
          "a column of times (t, time, timestamp, date, time (s), t_min, ..), or --time COLUMN, or "
          "--sample-time S");
  if (time.unit.empty()) remarks.push_back("'" + time.name + "' is taken to be in seconds");
  structure.time_column = time.name;  // rows that it lacks keep the pasts on both sides apart
  structure.time_unit = time.unit.empty() ? "s" : time.unit;
  structure.sample_time_s = std::round(time.step_s * 1e6) / 1e6;
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
