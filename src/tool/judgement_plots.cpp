#include <cstdio>
#include <filesystem>

#include "base/csv.hpp"
#include "base/files.hpp"
#include "base/list_of.hpp"
#include "base/ordered_json.hpp"
#include "runtime/plot.hpp"
#include "tool/judgement.hpp"
#include "tool/model_plots.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Eigen::Index;
using Json = OrderedJson;

Json correlationsOf(const RecordJudgement& part) {
  Json all = Json::object();
  for (const auto& o : part.outputs) {
    Json cross = Json::object();
    for (std::size_t i = 0; i < o.residual.signals.size(); ++i)
      cross[o.residual.signals[i]] = listOf(o.residual.cross.row(static_cast<Index>(i)));
    all[o.output] = {{"bound", o.residual.bound},
                     {"outside", o.residual.outside},
                     {"auto", listOf(o.residual.autocorrelation)},
                     {"cross", cross}};
  }
  return all;
}

CsvTable predictionsOf(const IdentifiedModel& model, const RecordJudgement& part) {
  const DataSet& data = part.data;
  const auto n_y = static_cast<Index>(data.outputs.size());
  const bool linear = model.has(ModelKind::kLinear);
  const Matrix line =
      linear ? predictKind(model, ModelKind::kLinear, data).free_run : part.best.free_run;
  CsvTable table;
  table.names = {"time"};
  table.units = {"s"};
  const Index each = 5;
  table.values.resize(data.rows(), 1 + each * n_y);
  table.values.col(0) = Vector::LinSpaced(
      data.rows(), 0.0, static_cast<double>(data.rows() - 1) * data.sample_time_s);
  for (Index i = 0; i < n_y; ++i) {
    const SignalInfo& y = data.outputs[static_cast<std::size_t>(i)];
    for (const char* what : {"", "_one_step", "_free_run", "_linear_free_run", "_laws_free_run"}) {
      table.names.push_back(y.name + what);
      table.units.push_back(y.unit);
    }
    const Index at = 1 + each * i;
    table.values.col(at) = data.values.col(i);
    table.values.col(at + 1) = part.best.one_step.col(i);
    table.values.col(at + 2) = part.best.free_run.col(i);
    table.values.col(at + 3) = line.col(i);
    table.values.col(at + 4) = part.laws.free_run.col(i);
  }
  addCauses(data, table);
  return table;
}

}  // namespace

void plotJudgements(const IdentifiedModel& model, const std::vector<RecordJudgement>& parts,
                    Json json, const std::string& folder) {
  makeFolder(folder);
  const fs::path path(folder);
  addModelJson(model.model, json);
  std::error_code error;
  for (const char* title : {"identification", "validation"})
    fs::remove(path / (std::string(title) + ".csv"), error);  // of an earlier run
  json["rules"] = Json::object();
  for (std::size_t i = 0; i < model.model.outputs.size(); ++i)
    json["rules"][model.model.outputs[i].name] = model.model.submodels[i].rules.size();
  for (const auto& part : parts) {
    json["correlations"][part.title] = correlationsOf(part);
    writeCsv(predictionsOf(model, part), (path / (part.title + ".csv")).string());
  }
  writeText(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n",
            inFolder(folder, "report.json"));
  const PlotResult plot = drawModelPlots(folder);
  if (!plot.warning.empty()) std::fprintf(stderr, "fmbpc: warning: %s\n", plot.warning.c_str());
}

}  // namespace fpc::tool
