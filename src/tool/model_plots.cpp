#include "tool/model_plots.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/files.hpp"
#include "base/list_of.hpp"
#include "base/ordered_json.hpp"
#include "runtime/plot.hpp"
#include "tool/model_points.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Json = OrderedJson;

constexpr int kPoints = 301;
constexpr double kMargin = 0.05;  // of the data's range, on both sides

/// Degree of one variable, the others where they are best.
double degreeOf(const Rule& rule, std::size_t variable, double value) {
  if (!rule.multivariate) return std::exp(rule.antecedents[variable].logDegree(value));
  const auto row = static_cast<Index>(variable);
  const double away = value - rule.multivariate->center[row];
  return std::exp(-0.5 * rule.multivariate->projectedPrecision(row) * away * away);
}

/// What one variable's sets look like over the range of the data.
Json membershipsOf(const TsModel& model, const OutputModel& submodel, std::size_t variable) {
  const Regressor& r = submodel.antecedents[variable];
  const SignalInfo& signal = model.signals(r.kind)[static_cast<std::size_t>(r.index)];
  const double span = signal.upper - signal.lower;
  Json z = Json::array(), degrees = Json::array();
  std::vector<double> grid;
  for (int i = 0; i < kPoints && std::isfinite(span); ++i)
    grid.push_back(signal.lower - kMargin * span +
                   (1.0 + 2.0 * kMargin) * span * i / (kPoints - 1.0));
  z = grid;
  for (const auto& rule : submodel.rules) {
    std::vector<double> of_rule;
    for (const double value : grid) of_rule.push_back(degreeOf(rule, variable, value));
    degrees.push_back(of_rule);
  }
  return {{"variable", model.text(r)},
          {"unit", signal.unit},
          {"projected", submodel.rules.front().multivariate.has_value()},
          {"z", z},
          {"degrees", degrees}};
}

Json correlationsOf(const JudgedRecord& judged) {
  Json all = Json::object();
  for (const auto& v : judged.outputs) {
    Json cross = Json::object();
    for (std::size_t i = 0; i < v.residual.signals.size(); ++i)
      cross[v.residual.signals[i]] = listOf(v.residual.cross.row(static_cast<Index>(i)));
    all[v.output] = {{"bound", v.residual.bound},
                     {"outside", v.residual.outside},
                     {"auto", listOf(v.residual.autocorrelation)},
                     {"cross", cross}};
  }
  return all;
}

void addColumn(CsvTable& table, const std::string& name, const std::string& unit,
               const Eigen::Ref<const Vector>& values) {
  const auto column = static_cast<Index>(table.names.size());
  table.names.push_back(name);
  table.units.push_back(unit);
  table.values.col(column) = values;
}

CsvTable predictions(const Identification& found, const DataSet& data) {
  const auto n_y = static_cast<Index>(data.outputs.size());
  const Matrix one_step = predictOneStep(found.model, data);
  const Matrix free_run = predictFreeRun(found.model, data);
  const Matrix linear = predictFreeRun(found.linear, data);
  CsvTable table;
  table.values.resize(data.rows(), 1 + 4 * n_y);
  addColumn(table, "time", "s",
            Vector::LinSpaced(data.rows(), 0.0,
                              static_cast<double>(data.rows() - 1) * data.sample_time_s));
  for (Index i = 0; i < n_y; ++i) {
    const SignalInfo& y = data.outputs[static_cast<std::size_t>(i)];
    addColumn(table, y.name, y.unit, data.values.col(i));
    addColumn(table, y.name + "_one_step", y.unit, one_step.col(i));
    addColumn(table, y.name + "_free_run", y.unit, free_run.col(i));
    addColumn(table, y.name + "_linear_free_run", y.unit, linear.col(i));
  }
  addCauses(data, table);
  return table;
}

/// Draws what stands in a folder.
void draw(const std::string& folder) {
  const PlotResult plot = drawModelPlots(folder);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

}  // namespace

Json membershipsJson(const TsModel& model) {
  Json all = Json::object();
  for (std::size_t i = 0; i < model.outputs.size(); ++i) {
    Json& sets = all[model.outputs[i].name] = Json::array();
    for (std::size_t j = 0; j < model.submodels[i].antecedents.size(); ++j)
      sets.push_back(membershipsOf(model, model.submodels[i], j));
  }
  return all;
}

void writeModelPlots(const IdentifyReport& report, const std::string& folder) {
  makeFolder(folder);
  const fs::path path(folder);
  Json json = Json::parse(toJson(report));
  const TsModel& model = report.found.model;
  addModelJson(model, json);
  std::error_code error;
  fs::remove(path / "validation.csv", error);  // of an earlier run
  for (const auto* judged :
       {&report.identification, report.validation ? &*report.validation : nullptr}) {
    if (judged == nullptr) continue;
    json["correlations"][judged->title] = correlationsOf(*judged);
    writeCsv(predictions(report.found, judged->data), (path / (judged->title + ".csv")).string());
  }
  writeText(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
            inFolder(folder, "report.json"));
  draw(folder);
}

void addModelJson(const TsModel& model, Json& json) {
  json["memberships"] = membershipsJson(model);
  json["points"] = pointsJson(model);
  json["sample_time_s"] = model.sample_time_s;
  json["causes"] = Json::array();
  for (const auto* signals : {&model.inputs, &model.disturbances})
    for (const auto& signal : *signals) json["causes"].push_back(signal.name);
}

void addCauses(const DataSet& data, CsvTable& table) {
  const auto n_y = static_cast<Index>(data.outputs.size()), before = table.values.cols();
  table.values.conservativeResize(Eigen::NoChange, before + data.values.cols() - n_y);
  table.values.rightCols(data.values.cols() - n_y) =
      data.values.rightCols(data.values.cols() - n_y);
  for (const auto* signals : {&data.inputs, &data.disturbances})
    for (const auto& signal : *signals) {
      table.names.push_back(signal.name);
      table.units.push_back(signal.unit);
    }
}

void plotModel(const TsModel& model, const std::string& folder) {
  makeFolder(folder);
  Json json{{"name", model.name}};
  addModelJson(model, json);
  std::error_code error;
  for (const char* name : {"identification.csv", "validation.csv"})
    fs::remove(fs::path(folder) / name, error);  // of an earlier run
  writeText(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
            inFolder(folder, "report.json"));
  draw(folder);
}

}  // namespace fpc::tool
