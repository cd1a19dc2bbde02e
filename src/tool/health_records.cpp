#include "tool/health_records.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/time_unit.hpp"
#include "config/identified_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/data_set.hpp"
#include "model/operating_points.hpp"
#include "runtime/report.hpp"
#include "supervision/health/finite_runs.hpp"
#include "tool/read_record.hpp"
#include "tool/record_files.hpp"
#include "tool/time_column.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

std::vector<double> cellsOf(const CsvTable& table, const std::string& name) {
  const auto column = table.values.col(table.column(name));
  return {column.begin(), column.end()};
}

bool hasColumn(const CsvTable& table, const std::string& name) {
  return std::find(table.names.begin(), table.names.end(), name) != table.names.end();
}

std::string columnUnit(const CsvTable& table, const std::string& name) {
  const auto at = static_cast<std::size_t>(table.column(name));
  return at < table.units.size() ? table.units[at] : "";
}

/// Rows "FIRST:LAST" of a table.
CsvTable rowsOf(CsvTable table, const std::string& rows) {
  if (rows.empty()) return table;
  const RowRange range = parseRows(rows);
  const Eigen::Index first = std::max<Eigen::Index>(range.first, 1) - 1;
  const Eigen::Index last = range.last == 0 ? table.rows() : std::min(range.last, table.rows());
  require(first < last, table.file, "rows within 1:" + std::to_string(table.rows()));
  table.values = Matrix(table.values.middleRows(first, last - first));
  return table;
}

std::pair<double, double> limitsOf(const std::string& text) {
  if (text.empty()) return {-kInfinity, kInfinity};
  const auto colon = text.find(':');
  const auto lower = numberOf(text.substr(0, colon));
  const auto upper = colon == std::string::npos ? lower : numberOf(text.substr(colon + 1));
  require(colon != std::string::npos && lower && upper && *lower < *upper,
          "--limits '" + text + "'", "LOWER:UPPER");
  return {*lower, *upper};
}

double recordSampleTime(const CsvTable& table, const HealthArguments& a,
                        const std::vector<std::string>& used, std::vector<std::string>& remarks) {
  if (a.sample_time_s > 0.0) return a.sample_time_s;
  const TimeColumn time = timeColumn(table, a.time, used);
  require(!time.name.empty(), table.file, "a column of times (--time) or --sample-time");
  if (time.unit.empty())
    remarks.push_back(table.file + ": '" + time.name + "' is taken to be in s");
  return time.step_s;
}

/// The input whose values go most with those of the output.
std::string closestInput(const CsvTable& table, const std::vector<double>& y,
                         const std::vector<std::string>& inputs) {
  std::string best;
  double most = -1.0;
  for (const std::string& name : inputs) {
    const std::vector<double> u = cellsOf(table, name);
    double product = 0.0, squares = 0.0, own = 0.0;
    const double mean_y = meanOf(y), mean_u = meanOf(u);
    for (std::size_t k = 0; k < y.size(); ++k) {
      if (!std::isfinite(y[k]) || !std::isfinite(u[k])) continue;
      product += (y[k] - mean_y) * (u[k] - mean_u);
      squares += (y[k] - mean_y) * (y[k] - mean_y);
      own += (u[k] - mean_u) * (u[k] - mean_u);
    }
    const double fit =
        squares > 0.0 && own > 0.0 ? std::abs(product) / std::sqrt(squares * own) : 0.0;
    if (fit > most) {
      most = fit;
      best = name;
    }
  }
  return best;
}

StepResponse modelResponse(const TsModel& model, const ControlRecord& r) {
  const auto index = [](const std::vector<SignalInfo>& signals, const std::string& name) {
    for (std::size_t i = 0; i < signals.size(); ++i)
      if (signals[i].name == name) return static_cast<Eigen::Index>(i);
    return Eigen::Index{-1};
  };
  const Eigen::Index y = index(model.outputs, r.output), u = index(model.inputs, r.input);
  if (y < 0 || u < 0) return {};
  const double mean = meanOf(r.u);
  const OperatingPoint* nearest = nullptr;
  const std::vector<OperatingPoint> points = operatingPoints(model);
  for (const OperatingPoint& point : points)
    if (nearest == nullptr ||
        std::abs(point.inputs[u] - mean) < std::abs(nearest->inputs[u] - mean))
      nearest = &point;
  if (nearest == nullptr) return {};
  const auto column = nearest->steps[static_cast<std::size_t>(u)].col(y);
  return {model.sample_time_s, {column.begin(), column.end()}, {}};
}

void addNamedModel(const HealthArguments& a, std::vector<NamedRecord>& records,
                   std::vector<std::string>& remarks) {
  if (a.model.empty()) return;
  const TsModel model = readIdentified(requireModel(a.model)).model;
  bool used = false;
  for (NamedRecord& named : records) {
    named.record.model = modelResponse(model, named.record);
    used = used || !named.record.model.empty();
  }
  if (!used)
    remarks.push_back("model '" + model.name + "' has no output and input of these names, or no " +
                      "ranges: it is not judged");
}

void setDeadTimes(const HealthArguments& a, std::vector<NamedRecord>& records) {
  const std::size_t given = a.dead_times_s.size();
  require(given <= 1 || given == records.size(), "--dead-time",
          "one number, or one for each of " + std::to_string(records.size()) + " loops");
  if (given == 0) return;
  for (std::size_t i = 0; i < records.size(); ++i)
    records[i].record.dead_time_s = a.dead_times_s[given == 1 ? 0 : i];
}

std::vector<LoopDuty> dutyColumn(const CsvTable& table, const HealthArguments& a) {
  if (a.mode.empty()) return {};
  const auto values = [](const std::vector<std::string>& words, const char* option) {
    std::vector<double> numbers;
    for (const std::string& word : words) {
      const auto number = numberOf(word);
      require(number.has_value(), std::string(option) + " '" + word + "'", "a number");
      numbers.push_back(*number);
    }
    return numbers;
  };
  const std::vector<double> automatic = values(a.automatic, "--automatic"),
                            manual = values(a.manual, "--manual"),
                            fallback = values(a.fallback, "--fallback");
  const auto among = [](const std::vector<double>& all, double value) {
    return std::find(all.begin(), all.end(), value) != all.end();
  };
  std::vector<LoopDuty> duty;
  for (const double mode : cellsOf(table, a.mode))
    duty.push_back(among(automatic, mode)  ? LoopDuty::kAutomatic
                   : among(manual, mode)   ? LoopDuty::kManual
                   : among(fallback, mode) ? LoopDuty::kFallback
                                           : LoopDuty::kHeld);
  return duty;
}

void addHistorian(const std::string& file, const HealthArguments& a,
                  std::vector<NamedRecord>& records, std::vector<std::string>& remarks) {
  require(!a.outputs.empty(), file, "--outputs: the columns of measured values of its loops");
  for (const auto* columns : {&a.setpoints, &a.inputs, &a.positions})
    require(columns->empty() || columns->size() == a.outputs.size(), file,
            "as many columns of each kind as --outputs");
  const CsvTable table = rowsOf(readRecord(file, csvFormat(a.format), !a.format.no_header), a.rows);
  std::vector<std::string> used = a.outputs;
  for (const auto* columns : {&a.setpoints, &a.inputs, &a.positions})
    used.insert(used.end(), columns->begin(), columns->end());
  const double sample_time_s = recordSampleTime(table, a, used, remarks);
  const auto [lower, upper] = limitsOf(a.limits);
  for (std::size_t i = 0; i < a.outputs.size(); ++i) {
    ControlRecord r;
    r.output = a.outputs[i];
    r.unit = columnUnit(table, r.output);
    r.sample_time_s = sample_time_s;
    r.y = cellsOf(table, r.output);
    if (!a.setpoints.empty()) r.setpoint = cellsOf(table, a.setpoints[i]);
    if (!a.inputs.empty()) {
      r.input = a.inputs[i];
      r.input_unit = columnUnit(table, r.input);
      r.u = cellsOf(table, r.input);
    }
    if (!a.positions.empty()) r.position = cellsOf(table, a.positions[i]);
    r.u_lower = lower;
    r.u_upper = upper;
    r.duty = dutyColumn(table, a);
    records.push_back({fs::path(file).stem().string() + "_" + r.output, std::move(r)});
  }
}

/// By the counts of the summary: the files of a run do not say which samples they were.
void addRunFolder(const std::string& folder, const HealthArguments& a,
                  std::vector<NamedRecord>& records, std::vector<std::string>& remarks) {
  const Summary summary = readSummary((fs::path(folder) / "summary.json").string());
  const CsvTable table = rowsOf(readCsv((fs::path(folder) / "trajectory.csv").string()), a.rows);
  std::vector<std::string> inputs;
  for (const std::string& name : summary.input_names)
    if (hasColumn(table, name + "_commanded")) inputs.push_back(name + "_commanded");
  for (std::size_t i = 0; i < summary.output_names.size(); ++i) {
    const std::string& name = summary.output_names[i];
    if (i < summary.controlled.size() && !summary.controlled[i]) continue;
    if (!hasColumn(table, name) || !hasColumn(table, name + "_setpoint")) continue;
    ControlRecord r;
    r.output = name;
    r.unit = summary.output_units[i];
    r.y = cellsOf(table, name);
    r.setpoint = cellsOf(table, name + "_setpoint");
    if (!std::isfinite(meanOf(r.setpoint))) continue;
    r.sample_time_s = recordSampleTime(table, a, {name}, remarks);
    const std::string input = closestInput(table, r.y, inputs);
    for (std::size_t j = 0; j < summary.input_names.size(); ++j) {
      if (summary.input_names[j] + "_commanded" != input) continue;
      r.input = summary.input_names[j];
      r.input_unit = summary.input_units[j];
      r.u = cellsOf(table, input);
      const auto at = static_cast<Eigen::Index>(j);
      if (at < summary.limits.lower.size()) {
        r.u_lower = summary.limits.lower[at];
        r.u_upper = summary.limits.upper[at];
      }
    }
    const std::vector<std::uint64_t>& s = summary.sources;
    if (s.size() > 7) r.counts = {s[1] + s[2] + s[3] + s[7], s[5], s[6], s[4]};
    records.push_back(
        {fs::absolute(folder).lexically_normal().filename().string() + "_" + name, std::move(r)});
  }
}

bool isRun(const fs::path& folder) {
  return fs::is_regular_file(folder / "trajectory.csv") &&
         fs::is_regular_file(folder / "summary.json");
}

}  // namespace

std::vector<NamedRecord> healthRecords(const HealthArguments& a,
                                       std::vector<std::string>& remarks) {
  std::vector<NamedRecord> records;
  for (const std::string& name : a.records) {
    if (!fs::is_directory(name)) {
      addHistorian(name, a, records, remarks);
      continue;
    }
    std::vector<std::string> runs;
    if (isRun(name)) runs.push_back(name);
    if (runs.empty())
      for (const auto& entry : fs::directory_iterator(name))
        if (isRun(entry.path())) runs.push_back(entry.path().string());
    std::sort(runs.begin(), runs.end());
    require(!runs.empty(), name, "a folder of a run (trajectory.csv and summary.json), or of runs");
    for (const std::string& run : runs) addRunFolder(run, a, records, remarks);
  }
  require(!records.empty(), a.records.front(), "a loop: an output with a setpoint");
  setDeadTimes(a, records);
  addNamedModel(a, records, remarks);
  return records;
}

}  // namespace fpc::tool
