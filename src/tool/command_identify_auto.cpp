// fmbpc identify DATA.. --auto: the structure is searched; the verdict comes first.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <optional>

#include "base/files.hpp"
#include "base/ordered_json.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/record_remarks.hpp"
#include "tool/auto_structure.hpp"
#include "tool/figures_json.hpp"
#include "tool/identify_auto.hpp"
#include "tool/identify_verdict.hpp"
#include "tool/judgement.hpp"
#include "tool/model_points.hpp"
#include "tool/progress_bar.hpp"
#include "tool/read_record.hpp"
#include "tool/record_files.hpp"
#include "tool/time_column.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;
using Row = std::vector<std::string>;

struct AutoRecords {
  std::vector<DataSet> each;
  DataSet joined;
  std::optional<DataSet> validation;
  std::vector<PriorKnowledge> known;
  std::vector<std::string> remarks;
};

AutoRecords recordsOf(const IdentifyArguments& a, const IdentifyTables& tables) {
  AutoRecords r;
  const CsvTable& first = tables.data.front();
  const AutoColumns columns{a.outputs, a.inputs, a.disturbances, a.time, a.sample_time_s};
  const Structure structure = autoStructure(first, columns, r.remarks);
  if (!a.known.empty()) r.known = readKnown(a.known, structure);
  const auto take = [&](const CsvTable& table, const std::string& rows) {
    return makeJoinedData(table, structure, rows, r.remarks);
  };
  for (const CsvTable& table : tables.data) r.each.push_back(take(table, a.rows));
  r.joined = joinRecords(r.each);
  if (!tables.validation && a.validate_rows.empty()) return r;
  r.validation = take(tables.validation ? *tables.validation : first, a.validate_rows);
  if (!tables.validation && rowsOverlap(a.rows, a.validate_rows))
    r.remarks.push_back("validation rows are among the identification rows: not held out");
  return r;
}

/// Of --kind; none: the best.
std::optional<ModelKind> kindOf(const std::string& word) {
  for (const auto kind : {ModelKind::kLinear, ModelKind::kRegressors, ModelKind::kState})
    if (name(kind) == word) return kind;
  return std::nullopt;
}

AutoIdentification search(const IdentifyArguments& a, const AutoRecords& records,
                          const AutoCallback& progress) {
  AutoParams params;
  params.work = a.work;
  params.budget_s = a.budget_s;
  params.blocks = a.blocks;
  params.window = a.window;
  params.reach = a.reach;
  params.seed = a.seed;
  params.known = records.known;
  params.longest_delay = a.longest_delay;
  params.rows = a.input_row == "next"   ? RowReading::kNext
                : a.input_row == "same" ? RowReading::kSame
                                        : RowReading::kFound;
  params.keep_still = a.keep_inputs;
  const std::optional<ModelKind> kind = kindOf(a.kind);
  params.states = !kind || kind == ModelKind::kState;
  AutoIdentification found = autoIdentify(records.joined, params, progress);
  if (kind) chooseByKind(*kind, found);
  return found;
}

std::string blocksText(const AutoFigures& f) {
  Row words;
  for (const double b : f.blocks) words.push_back(shortText(b));
  return join(words, " ");
}

std::string crossTable(const AutoIdentification& found) {
  std::vector<Row> rows{{"held-out blocks", "model", "confirmed", "mean of blocks", "free-run RMSE",
                         "fit %", "1-step RMSE", "95 % interval +-",
                         "free-run RMSE of the blocks"}};
  for (const auto& o : found.outputs) {
    std::string label = o.output;
    const auto add = [&](ModelKind kind, const AutoFigures& f) {
      if (f.blocks.empty()) return;
      rows.push_back({label, name(kind) + (kind == o.best ? " *" : ""), shortText(f.confirmed),
                      shortText(f.mean), shortText(f.free_run), shortText(f.fit),
                      shortText(f.one_step), shortText(f.width), blocksText(f)});
      label.clear();
    };
    add(ModelKind::kBlend, o.blend);
    add(ModelKind::kState, o.state);
    add(ModelKind::kRegressors, o.regressors);
    add(ModelKind::kLinear, o.linear);
  }
  return alignedTable(rows) +
         "(confirmed: mean of the blocks' free-run RMSE, each block by the model that the others "
         "would have chosen;\n the star goes by it)\n";
}

std::string searchTable(const AutoIdentification& found) {
  std::vector<Row> rows{{"structures of", "kind", "structure", "parameters",
                         "held-out free-run RMSE, mean of blocks", "+-", ""}};
  for (const auto& t : found.trials)
    rows.push_back({t.output, name(t.kind), t.structure, std::to_string(t.parameters),
                    shortText(t.free_run), shortText(t.spread), t.chosen ? "chosen" : ""});
  return alignedTable(rows);
}

Json toJson(const AutoFigures& f) {
  if (f.blocks.empty()) return nullptr;
  Json blocks = Json::array();
  for (const double b : f.blocks) blocks.push_back(numberOrNull(b));
  return {{"confirmed", numberOrNull(f.confirmed)}, {"mean_of_blocks", numberOrNull(f.mean)},
          {"free_run", numberOrNull(f.free_run)},   {"fit", numberOrNull(f.fit)},
          {"one_step", numberOrNull(f.one_step)},   {"blocks", blocks},
          {"half_width", numberOrNull(f.width)}};
}

/// What the judgements say before all figures.
Row firstWords(const std::vector<RecordJudgement>& parts) {
  Row all;
  for (const auto& part : parts)
    for (const auto& words : warnings(part)) all.push_back(part.title + ": " + words);
  return all;
}

Json toJson(const AutoIdentification& found, const std::vector<RecordJudgement>& parts,
            const std::vector<std::string>& remarks, double seconds) {
  Json json{{"name", found.model.name}, {"source", found.model.source}};
  for (const auto& o : found.outputs) {
    json["verdict"][o.output] = o.verdict;
    json["beats_linear"][o.output] = o.beats_linear;
    json["cross_validation"][o.output] = {{"best", name(o.best)},
                                          {"blend", toJson(o.blend)},
                                          {"state", toJson(o.state)},
                                          {"regressors", toJson(o.regressors)},
                                          {"linear", toJson(o.linear)}};
    json["delays"][o.output] = o.delay;
  }
  json["identification"] = nullptr;
  json["validation"] = nullptr;
  for (const auto& part : parts) {
    if (part.title == "identification" || part.title == "validation")
      json[part.title] = toJson(part);
    else
      json["records"][part.title] = toJson(part);
  }
  json["reach"] = found.reach;
  json["search"] = Json::array();
  for (const auto& t : found.trials)
    json["search"].push_back({{"output", t.output},
                              {"kind", name(t.kind)},
                              {"structure", t.structure},
                              {"parameters", t.parameters},
                              {"free_run", numberOrNull(t.free_run)},
                              {"spread", numberOrNull(t.spread)},
                              {"chosen", t.chosen}});
  json["points"] = pointsJson(found.model);
  json["warnings"] = firstWords(parts);
  json["remarks"] = remarks;
  json["work"] = found.work;
  json["seconds"] = seconds;
  return json;
}

std::vector<RecordJudgement> judgeAll(const AutoRecords& records, const IdentifiedModel& model) {
  constexpr int kSteps = 10;
  std::vector<RecordJudgement> parts{judgeRecord("identification", records.joined, model, kSteps)};
  for (std::size_t i = 0; records.each.size() > 1 && i < records.each.size(); ++i)
    parts.push_back(judgeRecord(records.each[i].source, records.each[i], model, kSteps));
  if (records.validation)
    parts.push_back(judgeRecord("validation", *records.validation, model, kSteps));
  return parts;
}

/// The model of what was found; validation rows may refuse it unless it was asked for by --kind.
IdentifiedModel settle(const IdentifyArguments& a, const AutoRecords& records,
                       AutoIdentification& found) {
  IdentifiedModel model = toIdentified(found);
  const auto kind = kindOf(a.kind);
  const bool asked = kind == ModelKind::kState || kind == ModelKind::kLinear;
  if (!records.validation || asked) return model;
  const auto validation = judgeRecord("validation", *records.validation, model, 1);
  return chooseByValidation(validation, found) ? toIdentified(found) : model;
}

Row remarksOf(const AutoRecords& records, const AutoIdentification& found,
              const IdentifiedModel& model, const std::vector<RecordJudgement>& parts) {
  Row remarks = found.contradictions;
  remarks.insert(remarks.end(), records.remarks.begin(), records.remarks.end());
  const auto add = [&remarks](const std::string& before, const Row& more) {
    for (const auto& remark : more) remarks.push_back(before + remark);
  };
  if (found.cancelled) remarks.push_back("stopped: the best found so far is kept");
  add("", found.remarks);
  const TsModel linear = model.linearModel();
  add("", recordRemarks(asRead(records.joined, model.same_row), &linear));
  for (const auto& part : parts) add(part.title + ": ", part.remarks);
  if (records.validation)
    add("validation: ", recordRemarks(asRead(*records.validation, model.same_row), nullptr));
  return remarks;
}

void checkArguments(const IdentifyArguments& a) {
  require(!a.outputs.empty(), "--outputs", "the columns to predict, NAME,NAME,..");
  require(!a.inputs.empty() || !a.disturbances.empty(), "--inputs",
          "the columns that act on them, NAME,NAME,..");
  checkTarget(a.out);
}

/// What callers other than the command line may have set otherwise.
void checkSearch(const IdentifyArguments& a) {
  const auto oneOf = [](const std::string& word, const char* name, const Row& known) {
    require(std::find(known.begin(), known.end(), word) != known.end(), name,
            join(known) + ", got '" + word + "'");
  };
  oneOf(a.kind, "kind", {"best", "linear", "regressors", "state"});
  oneOf(a.input_row, "input_row", {"auto", "next", "same"});
  require(a.work > 0.0 && std::isfinite(a.work), "work", "a number > 0");
  require(a.budget_s >= 0.0 && std::isfinite(a.budget_s), "budget_s", "seconds, or 0");
  require(a.sample_time_s >= 0.0 && std::isfinite(a.sample_time_s), "sample_time_s",
          "seconds, or 0");
  require(a.blocks >= 2 && a.blocks <= 20, "blocks", "2..20");
  require(a.window >= 1 && a.window <= 1000, "window", "1..1000");
  require(a.reach >= -1 && a.reach <= 100000, "reach", "-1..100000");
  require(a.longest_delay >= 0, "longest_delay", "samples, or 0");
}

}  // namespace

IdentifyTables readTables(const IdentifyArguments& a, const CsvFormat& format) {
  IdentifyTables tables;
  for (const auto& file : a.data)
    tables.data.push_back(readRecord(file, format, !a.format.no_header));
  std::error_code ignored;  // the reader names a file that is not there
  const bool same = a.validate.empty() || fs::equivalent(a.validate, a.data.front(), ignored);
  if (!same) tables.validation = readRecord(a.validate, format, !a.format.no_header);
  if (same && !a.validate.empty() && a.validate_rows.empty()) tables.validate_all = true;
  return tables;
}

AutoReport searchModel(IdentifyArguments a, const IdentifyTables& tables,
                       const AutoCallback& progress) {
  checkSearch(a);
  if (tables.validate_all) a.validate_rows = ":";
  const AutoRecords records = recordsOf(a, tables);
  const auto start = std::chrono::steady_clock::now();
  AutoReport report;
  report.found = search(a, records, progress);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  report.seconds = wall.count();
  report.source = records.joined.source;
  if (!a.out.empty()) report.found.model.name = fs::path(a.out).stem().string();
  report.model = settle(a, records, report.found);
  report.parts = judgeAll(records, report.model);
  if (records.validation) tellCoverage(report.parts.back(), report.found);
  report.remarks = remarksOf(records, report.found, report.model, report.parts);
  report.json = toJson(report.found, report.parts, report.remarks, report.seconds);
  return report;
}

int identifyAuto(const IdentifyArguments& a) {
  checkArguments(a);
  const IdentifyTables tables = readTables(a, csvFormat(a.format));
  catchInterrupts();
  AutoReport report;
  {
    ProgressBar bar("auto");
    report = searchModel(a, tables, [&bar](const AutoProgress& progress) {
      bar.show(progress.share, progress.stage);
      return !interruption();
    });
  }
  if (!a.out.empty()) writeText(writeIdentified(report.model), a.out);
  if (!a.plots.empty()) plotJudgements(report.model, report.parts, report.json, a.plots);
  if (a.json) {
    std::cout << report.json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
    return 0;
  }
  for (const auto& o : report.found.outputs) std::cout << o.output << ": " << o.verdict << "\n";
  for (const auto& words : firstWords(report.parts)) std::cout << "warning: " << words << "\n";
  for (const auto& remark : report.remarks) std::cout << "remark: " << remark << "\n";
  std::cout << "\n"
            << crossTable(report.found) << "\n"
            << searchTable(report.found) << "\n"
            << toTable(report.parts) << "\n"
            << pointsTable(report.model.model) << "\n";
  std::cout << "searched " << report.source << " in " << shortText(report.seconds) << " s, "
            << shortText(report.found.work) << " of work\n";
  if (!a.out.empty()) std::cout << "written: " << a.out << "\n";
  return 0;
}

int identify(const IdentifyArguments& a) {
  if (a.automatic) return identifyAuto(a);
  require(a.data.size() == 2, "identify",
          "DATA and STRUCTURE, or --auto with --inputs and --outputs");
  IdentifyArguments structured = a;
  structured.structure = a.data.back();
  structured.data.resize(1);
  return identifyStructure(structured);
}

}  // namespace fpc::tool
