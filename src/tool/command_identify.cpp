// fmbpc identify DATA STRUCTURE: from a record to a model file and an honest report.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "base/files.hpp"
#include "config/loop_file.hpp"
#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "tool/commands.hpp"
#include "tool/identify_auto.hpp"
#include "tool/identify_report.hpp"
#include "tool/model_plots.hpp"
#include "tool/progress_bar.hpp"
#include "tool/read_record.hpp"
#include "tool/record_files.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;

struct Records {
  DataSet identification;
  std::optional<DataSet> validation;
  bool overlap{false};  ///< validation rows were identified from
};

Records recordsOf(const IdentifyArguments& a, const IdentifyTables& tables,
                  const Structure& structure) {
  Records records{makeData(tables.data.front(), structure, a.rows), {}, false};
  if (!tables.validation && a.validate_rows.empty() && !tables.validate_all) return records;
  Structure judging = structure;
  judging.repair.drop_constant = true;  // an input may rest while a model is judged
  records.validation = makeData(tables.validation ? *tables.validation : tables.data.front(),
                                judging, a.validate_rows);
  records.overlap = !tables.validation && rowsOverlap(a.rows, a.validate_rows);
  return records;
}

JudgedRecord judge(const std::string& title, DataSet data, const Identification& found,
                   const ValidationParams& params) {
  JudgedRecord judged{title, std::move(data), {}};
  judged.outputs = validateModel(found.model, found.linear, judged.data, params);
  return judged;
}

void addRemarks(const Records& records, IdentifyReport& report) {
  report.remarks = report.found.remarks;
  for (const auto& remark : reportModel(report.found.model))
    report.remarks.push_back(remark.output + " rule " + std::to_string(remark.rule) + ": " +
                             remark.text);
  if (records.validation)
    for (const auto& repair : records.validation->repairs)
      report.remarks.push_back("validation data: " + repair);
  if (records.overlap)
    report.remarks.push_back("validation rows are among the identification rows: not held out");
}

}  // namespace

IdentifyReport identifyWith(const IdentifyArguments& a, const IdentifyTables& tables,
                            const IdentifyCallback& progress) {
  std::vector<PriorKnowledge> known;
  const Structure structure = readStructure(findStructure(a.structure), &known);
  if (!a.known.empty()) known = readKnown(a.known, structure);
  const Records records = recordsOf(a, tables, structure);
  const auto start = std::chrono::steady_clock::now();
  IdentifyReport report;
  report.found = identify(records.identification, structure, progress, known);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  report.seconds = wall.count();
  if (report.found.cancelled) return report;
  report.identification =
      judge("identification", records.identification, report.found, structure.validation);
  if (records.validation)
    report.validation =
        judge("validation", *records.validation, report.found, structure.validation);
  addRemarks(records, report);
  return report;
}

int identifyStructure(const IdentifyArguments& a) {
  const Structure structure = readStructure(findStructure(a.structure));
  checkTarget(a.out);
  const IdentifyTables tables = readTables(a, structure.csv);
  catchInterrupts();
  IdentifyReport report;
  {
    ProgressBar bar(structure.name);
    report = identifyWith(a, tables, [&bar](const IdentifyProgress& progress) {
      bar.show(progress.share, progress.output + ": " + progress.stage);
      return !interruption();
    });
  }
  if (report.found.cancelled || interruption()) {
    std::fprintf(stderr, "fmbpc: interrupted, nothing is written\n");
    return kInterrupted;
  }
  if (!a.out.empty()) writeText(writeModel(report.found.model), a.out);
  if (!a.plots.empty()) writeModelPlots(report, a.plots);
  std::cout << (a.json ? toJson(report) + "\n" : toTables(report));
  if (!a.json && !a.out.empty()) std::cout << "written: " << a.out << "\n";
  if (!a.json && !a.plots.empty()) std::cout << "written: " << a.plots << "\n";
  return 0;
}

}  // namespace fpc::tool
