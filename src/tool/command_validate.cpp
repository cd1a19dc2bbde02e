// fmbpc validate MODEL DATA: a saved model on another record.
#include <algorithm>
#include <iostream>
#include <limits>
#include <map>

#include "base/ordered_json.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/record_remarks.hpp"
#include "tool/auto_structure.hpp"
#include "tool/commands.hpp"
#include "tool/identify_verdict.hpp"
#include "tool/judgement.hpp"
#include "tool/read_record.hpp"
#include "tool/record_files.hpp"
#include "tool/time_column.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

std::map<std::string, std::string> columnsOf(const std::vector<std::string>& pairs) {
  std::map<std::string, std::string> columns;
  for (const auto& pair : pairs) {
    const auto at = pair.find('=');
    require(at != std::string::npos && at > 0 && at + 1 < pair.size(), "--columns '" + pair + "'",
            "SIGNAL=COLUMN");
    require(columns.emplace(pair.substr(0, at), pair.substr(at + 1)).second,
            "--columns '" + pair + "'", "every signal only once");
  }
  return columns;
}

void requireSignals(const std::map<std::string, std::string>& columns, const TsModel& model) {
  std::vector<std::string> names;
  for (const auto* signals : {&model.outputs, &model.inputs, &model.disturbances})
    for (const SignalInfo& signal : *signals) names.push_back(signal.name);
  for (const auto& [name, column] : columns)
    require(std::find(names.begin(), names.end(), name) != names.end(),
            "--columns '" + name + "=" + column + "'", "a signal of the model: " + join(names));
}

/// Rows are samples only where the times say so.
void setTimes(const CsvTable& table, Structure& structure, std::vector<std::string>& remarks) {
  std::vector<std::string> used;
  for (const auto* signals : {&structure.outputs, &structure.inputs, &structure.disturbances})
    for (const StructureSignal& signal : *signals) used.push_back(signal.column);
  TimeColumn time = timeColumn(table, "", used);
  if (time.name.empty()) {
    remarks.push_back("no time column found: rows are taken as samples");
    return;
  }
  const bool told = !time.unit.empty();
  time.fitTo(structure.sample_time_s);
  if (!told)
    remarks.push_back("'" + time.name + "' is taken to be in " +
                      (time.unit.empty() ? "s" : time.unit));
  structure.time_column = time.name;
  structure.time_unit = time.unit.empty() ? "s" : time.unit;
}

/// The model's signals as a structure; anything may be missing or rest while a model is judged.
Structure structureOf(const TsModel& model, const CsvTable& table,
                      const std::map<std::string, std::string>& columns) {
  const double infinite = std::numeric_limits<double>::infinity();
  const auto signals = [&](const std::vector<SignalInfo>& infos) {
    std::vector<StructureSignal> list;
    for (SignalInfo info : infos) {
      info.lower = -infinite;
      info.upper = infinite;
      const auto given = columns.find(info.name);
      std::string column = given == columns.end() ? info.name : given->second;
      if (given == columns.end())
        for (const auto& name : table.names)
          if (signalName(name) == info.name) column = name;
      StructureSignal& signal = list.emplace_back();
      signal.info = info;
      signal.column = column;
    }
    return list;
  };
  Structure s;
  s.name = model.name;
  s.sample_time_s = model.sample_time_s;
  s.outputs = signals(model.outputs);
  s.inputs = signals(model.inputs);
  s.disturbances = signals(model.disturbances);
  for (const auto& submodel : model.submodels) {
    OutputStructure part;
    part.regressors = submodel.regressors;
    part.antecedents = submodel.antecedents;
    s.submodels.push_back(part);
  }
  s.repair.missing = MissingCells::kDrop;
  s.repair.drop_constant = true;
  return s;
}

/// What comes before all figures.
std::vector<std::string> firstWords(const RecordJudgement& part) {
  std::vector<std::string> words = warnings(part);
  for (const auto& o : part.outputs) {
    const std::string covered = coverageWords(o);
    if (!covered.empty()) words.push_back(o.output + ": " + covered);
  }
  return words;
}

}  // namespace

ValidationReport validateOn(const CsvTable& table, const IdentifiedModel& model,
                            const ValidateArguments& a) {
  const auto columns = columnsOf(a.columns);
  requireSignals(columns, model.model);
  Structure structure = structureOf(model.model, table, columns);
  std::vector<std::string> remarks;
  if (!a.no_time) setTimes(table, structure, remarks);
  const DataSet data = makeJoinedData(table, structure, a.rows, remarks);
  ValidationReport report{judgeRecord("validation", data, model, a.steps), {}, {}, {}};
  const RecordJudgement& part = report.part;
  remarks.insert(remarks.end(), data.repairs.begin(), data.repairs.end());
  for (const auto& remark : recordRemarks(asRead(data, model.same_row), nullptr))
    remarks.push_back(remark);
  remarks.insert(remarks.end(), part.remarks.begin(), part.remarks.end());
  Json json{{"name", model.model.name}, {"data", data.source}, {"validation", toJson(part)}};
  const std::vector<std::string> first = firstWords(part);
  json["warnings"] = first;
  json["remarks"] = remarks;
  report.warnings = first;
  report.remarks = std::move(remarks);
  report.json = std::move(json);
  return report;
}

int validate(const ValidateArguments& a) {
  const IdentifiedModel model = readIdentified(requireModel(a.model));
  const ValidationReport report =
      validateOn(readRecord(a.data, csvFormat(a.format), !a.format.no_header), model, a);
  if (!a.plots.empty()) plotJudgements(model, {report.part}, report.json, a.plots);
  if (a.json) {
    std::cout << report.json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
    return 0;
  }
  for (const auto& words : report.warnings) std::cout << "warning: " << words << "\n";
  std::cout << model.model.name << " on " << report.part.data.source << "\n\n"
            << toTable({report.part}) << "\n";
  for (const auto& remark : report.remarks) std::cout << "remark: " << remark << "\n";
  if (!a.plots.empty()) std::cout << "written: " << a.plots << "\n";
  return 0;
}

}  // namespace fpc::tool
