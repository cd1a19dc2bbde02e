// What every kind of model in a file makes of one record, as tables, JSON and plots.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/ordered_json.hpp"
#include "config/identified_file.hpp"

namespace fpc::tool {

/// Figures of one kind on one output. Coverage [%] of the 95 % intervals; NaN: no interval. Least:
/// what chance leaves of it, see leastCoverage().
struct KindFigures {
  ModelKind kind{};
  FitFigures one_step, free_run;
  double one_step_coverage{}, free_run_coverage{};
  double one_step_least{}, free_run_least{};
  double one_step_width{}, free_run_width{};
};

struct OutputJudgement {
  std::string output, unit;
  ModelKind best{};
  /// No `regressors` where these are the linear model; `blend` where there is one.
  std::vector<KindFigures> kinds;
  FitFigures ahead;  ///< of the best kind, `steps` samples ahead
  ModelKind laws{};  ///< the kind that control laws take: regressors, or linear
  FitFigures laws_ahead;
  ResidualCorrelation residual;
};

/// One record (or part of one) judged.
struct RecordJudgement {
  std::string title;  ///< "identification", "validation"
  DataSet data;       ///< without outliers
  int steps{};
  Eigen::Index reach{};  ///< of the free runs, see IdentifiedModel
  std::vector<OutputJudgement> outputs;
  KindPrediction best, laws;  ///< laws: of the model that control laws take
  std::vector<std::string> remarks;
};
/// Of one kind; null: it was not judged.
const KindFigures* figuresOf(const OutputJudgement& o, ModelKind kind);
/// Of the best kind, or of what stands for it.
const KindFigures& bestFigures(const OutputJudgement& o);
/// `data` as the record has it: its rows are read as the model says (asRead()), its outliers left
/// out (withoutOutliers()).
RecordJudgement judgeRecord(const std::string& title, const DataSet& data,
                            const IdentifiedModel& model, int steps,
                            const ValidationParams& params = {});

std::string toTable(const std::vector<RecordJudgement>& parts);
/// <output>.{best, one_step, free_run, ahead, residual, interval, <kind>..}, linear.<output>..
OrderedJson toJson(const RecordJudgement& part);
/// Pictures and their data into a folder; `json` is what the command prints.
void plotJudgements(const IdentifiedModel& model, const std::vector<RecordJudgement>& parts,
                    OrderedJson json, const std::string& folder);

struct ValidateArguments;
struct ValidationReport {
  RecordJudgement part;
  std::vector<std::string> warnings, remarks;
  OrderedJson json;
};
/// A model on another record; `arguments` say rows, columns and steps.
/// @throws InputError naming record and column.
ValidationReport validateOn(const CsvTable& table, const IdentifiedModel& model,
                            const ValidateArguments& arguments);

}  // namespace fpc::tool
