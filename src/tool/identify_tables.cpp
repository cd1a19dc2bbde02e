#include <cmath>
#include <cstdio>

#include "fmbpc/base/text.hpp"
#include "tool/identify_report.hpp"
#include "tool/model_points.hpp"

namespace fpc::tool {
namespace {

using Row = std::vector<std::string>;

std::string percent(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

Row figuresRow(const std::string& output, const std::string& title, const std::string& model,
               const FitFigures& one_step, const FitFigures& free_run) {
  Row row{output, title, model};
  for (const auto* figures : {&one_step, &free_run}) {
    const bool any = figures->samples > 0;
    row.push_back(any ? percent(figures->vaf) : "-");
    row.push_back(any ? percent(figures->fit) : "-");
    row.push_back(any ? shortText(figures->rmse) : "-");
  }
  row.push_back(std::to_string(one_step.samples));
  return row;
}

std::string figuresTable(const IdentifyReport& report) {
  std::vector<Row> rows{{"output", "rows", "model", "1-step VAF %", "fit %", "RMSE",
                         "free-run VAF %", "fit %", "RMSE", "samples"}};
  const auto& signals = report.found.model.outputs;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    std::string label = signals[i].name;
    if (!signals[i].unit.empty()) label += " [" + signals[i].unit + "]";
    for (const auto* judged :
         {&report.identification, report.validation ? &*report.validation : nullptr}) {
      if (judged == nullptr) continue;
      const OutputValidation& v = judged->outputs[i];
      rows.push_back(figuresRow(label, judged->title, "fuzzy", v.one_step, v.free_run));
      rows.push_back(figuresRow("", "", "linear", v.linear_one_step, v.linear_free_run));
      label.clear();
    }
  }
  return alignedTable(rows) + "(RMSE in the unit of the output)\n";
}

std::string trialsTable(const Identification& found) {
  std::vector<Row> rows{{"clusters of", "number", "Xie-Beni", "partition density",
                         "held-out 1-step RMSE", "free-run RMSE", "+-", ""}};
  for (std::size_t i = 0; i < found.outputs.size(); ++i)
    for (const auto& t : found.outputs[i].trials)
      rows.push_back(
          {found.outputs[i].output, std::to_string(t.clusters), shortText(t.validity.xie_beni),
           shortText(t.validity.partition_density), shortText(t.one_step_rmse),
           shortText(t.free_run_rmse), shortText(t.spread),
           static_cast<std::size_t>(t.clusters) == found.outputs[i].rules.size() ? "chosen" : ""});
  return rows.size() > 1 ? "\n" + alignedTable(rows) : "";
}

std::string residualTable(const IdentifyReport& report) {
  std::vector<Row> rows{{"residuals of", "rows", "correlations outside %", "bound"}};
  for (const auto* judged :
       {&report.identification, report.validation ? &*report.validation : nullptr}) {
    if (judged == nullptr) continue;
    for (const auto& v : judged->outputs)
      rows.push_back({v.output, judged->title, percent(100.0 * v.residual.outside),
                      shortText(v.residual.bound)});
  }
  return "\n" + alignedTable(rows);
}

std::string polesText(const RuleDynamics& dynamics) {
  Row words;
  for (const auto& pole : dynamics.poles) {
    if (pole.imag() < 0.0) continue;  // its conjugate says it
    words.push_back(shortText(pole.real()) +
                    (pole.imag() > 0.0 ? "+-" + shortText(pole.imag()) + "i" : ""));
  }
  return words.empty() ? "-" : join(words, " ");
}

std::string gainsText(const RuleDynamics& dynamics) {
  Row words;
  for (std::size_t i = 0; i < dynamics.signals.size(); ++i)
    words.push_back(dynamics.signals[i] + " " + shortText(dynamics.gains[i]));
  return join(words);
}

std::string rulesTable(const Identification& found) {
  static const char* const statuses[] = {"fitted", "borrowed", "dropped"};
  const auto all = ruleDynamics(found.model);
  std::vector<Row> rows{
      {"output", "rule", "data", "evidence", "condition", "status", "poles", "gains"}};
  auto dynamics = all.begin();
  for (const auto& output : found.outputs)
    for (std::size_t r = 0; r < output.rules.size(); ++r) {
      const RuleFit& fit = output.rules[r];
      Row row{r == 0 ? output.output : "",
              std::to_string(r + 1),
              std::to_string(fit.samples),
              shortText(fit.evidence),
              shortText(fit.condition),
              statuses[static_cast<std::size_t>(fit.status)],
              "-",
              "-"};
      if (fit.status != RuleStatus::kDropped && dynamics != all.end()) {
        row[6] = polesText(*dynamics);
        row[7] = gainsText(*dynamics);
        ++dynamics;
      }
      rows.push_back(row);
    }
  return "\n" + alignedTable(rows);
}

}  // namespace

std::string toTables(const IdentifyReport& report) {
  std::string text = report.found.model.name + ": identified from " +
                     report.identification.data.source + " in " + shortText(report.seconds) +
                     " s\n";
  text += report.validation
              ? "validated on " + report.validation->data.source + "\n\n"
              : "no held-out data: figures on identification data only (--validate-rows or "
                "--validate holds some out)\n\n";
  text += figuresTable(report) + trialsTable(report.found) + residualTable(report) +
          rulesTable(report.found);
  const std::string points = pointsTable(report.found.model);
  if (!points.empty()) text += "\n" + points;
  if (!report.remarks.empty()) text += "\n";
  for (const auto& remark : report.remarks) text += "remark: " + remark + "\n";
  return text;
}

}  // namespace fpc::tool
