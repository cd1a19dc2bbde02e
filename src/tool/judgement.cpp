#include "tool/judgement.hpp"

#include <cmath>
#include <cstdio>

#include "base/ordered_json.hpp"
#include "fmbpc/base/text.hpp"
#include "identification/interval_coverage.hpp"
#include "identification/prediction.hpp"
#include "identification/record_remarks.hpp"
#include "tool/figures_json.hpp"

namespace fpc::tool {
namespace {

using Eigen::Index;
using Json = OrderedJson;
using Row = std::vector<std::string>;

constexpr double kStated = 95.0;  // [%] that intervals are to hold

std::string fixed(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

KindFigures figuresOf(ModelKind kind, const KindPrediction& p, const Vector& measured, Index i) {
  KindFigures f;
  f.kind = kind;
  f.one_step = fitFigures(measured, p.one_step.col(i));
  f.free_run = fitFigures(measured, p.free_run.col(i));
  f.one_step_width = p.one_step_width[i];
  f.free_run_width = p.free_run_width[i];
  f.one_step_coverage = coverage(measured, p.one_step.col(i), f.one_step_width);
  f.free_run_coverage = coverage(measured, p.free_run.col(i), f.free_run_width);
  f.one_step_least = leastCoverage(independentCount(measured - p.one_step.col(i)), kStated);
  f.free_run_least = leastCoverage(independentCount(measured - p.free_run.col(i)), kStated);
  return f;
}

ModelKind bestOf(const IdentifiedModel& model, std::size_t i) {
  return i < model.outputs.size() ? model.outputs[i].best : ModelKind::kRegressors;
}

/// The file's own model of an output is the linear one beside it: one row tells all.
bool isLinear(const IdentifiedModel& model, std::size_t i) {
  return !model.linear.empty() && model.model.submodels[i].rules.size() == 1;
}

Json toJson(const KindFigures& f) {
  return {{"one_step", figuresJson(f.one_step)}, {"free_run", figuresJson(f.free_run)}};
}

Json intervalJson(const KindFigures& f) {
  const auto one = [](double width, double covered, double least) {
    return Json{{"half_width", width > 0.0 ? Json(width) : Json(nullptr)},
                {"coverage", numberOrNull(covered)},
                {"least_by_chance", width > 0.0 ? Json(least) : Json(nullptr)}};
  };
  return {{"stated", kStated},
          {"one_step", one(f.one_step_width, f.one_step_coverage, f.one_step_least)},
          {"free_run", one(f.free_run_width, f.free_run_coverage, f.free_run_least)}};
}

Row rowOf(const OutputJudgement& o, const KindFigures& f, const std::string& label,
          const std::string& title) {
  Row row{label, title,
          name(f.kind) + (f.kind == o.best ? " *" : "") + (f.kind == o.laws ? " (laws)" : "")};
  for (const auto* figures : {&f.one_step, &f.free_run}) {
    const bool any = figures->samples > 0;
    row.push_back(any ? fixed(figures->vaf) : "-");
    row.push_back(any ? fixed(figures->fit) : "-");
    row.push_back(any ? shortText(figures->rmse) : "-");
  }
  const FitFigures& ahead = f.kind == o.best ? o.ahead : o.laws_ahead;
  const bool has_ahead = (f.kind == o.best || f.kind == o.laws) && ahead.samples > 0;
  row.push_back(has_ahead ? shortText(ahead.rmse) : "-");
  row.push_back(fixed(f.free_run_coverage));
  row.push_back(std::to_string(f.free_run.samples));
  return row;
}

}  // namespace

const KindFigures* figuresOf(const OutputJudgement& o, ModelKind kind) {
  for (const auto& f : o.kinds)
    if (f.kind == kind) return &f;
  return nullptr;
}

const KindFigures& bestFigures(const OutputJudgement& o) {
  const KindFigures* best = figuresOf(o, o.best);
  return best != nullptr ? *best : o.kinds.front();
}

RecordJudgement judgeRecord(const std::string& title, const DataSet& data,
                            const IdentifiedModel& model, int steps,
                            const ValidationParams& params) {
  RecordJudgement part;
  part.title = title;
  part.data = withoutOutliers(asRead(data, model.same_row));
  part.steps = steps;
  part.reach = model.reach;
  part.best = predictBest(model, part.data);
  part.laws = predictKind(model, ModelKind::kRegressors, part.data);
  const AheadPrediction ahead = predictSteps(model, part.data, steps);
  for (std::size_t i = 0; i < model.model.outputs.size(); ++i) {
    const SignalInfo& y = model.model.outputs[i];
    OutputJudgement& o = part.outputs.emplace_back();
    o.output = y.name;
    o.unit = y.unit;
    o.best = bestOf(model, i);
    o.laws = isLinear(model, i) ? ModelKind::kLinear : ModelKind::kRegressors;
  }
  for (const auto kind :
       {ModelKind::kBlend, ModelKind::kState, ModelKind::kRegressors, ModelKind::kLinear}) {
    if (!model.has(kind)) continue;
    KindPrediction p = predictKind(model, kind, part.data);
    for (std::size_t i = 0; i < part.outputs.size(); ++i) {
      const auto c = static_cast<Index>(i);
      if (kind == ModelKind::kRegressors && isLinear(model, i)) continue;
      if (kind == ModelKind::kBlend && !(p.free_run_width[c] > 0.0)) continue;
      if (kind == ModelKind::kLinear && isLinear(model, i) && i < model.outputs.size()) {
        p.one_step_width[c] = model.outputs[i].one_step_width;
        p.free_run_width[c] = model.outputs[i].free_run_width;
      }
      part.outputs[i].kinds.push_back(figuresOf(kind, p, part.data.values.col(c), c));
    }
  }
  for (std::size_t i = 0; i < part.outputs.size(); ++i) {
    const auto c = static_cast<Index>(i);
    const Vector measured = part.data.values.col(c);
    part.outputs[i].ahead = fitFigures(measured, ahead.best.col(c));
    part.outputs[i].laws_ahead = fitFigures(measured, ahead.laws.col(c));
    part.outputs[i].residual =
        residualCorrelation(part.data, measured - part.best.one_step.col(c), params);
  }
  part.remarks =
      predictionRemarks(model.model, part.data, part.best.one_step, part.best.free_run, params);
  return part;
}

std::string toTable(const std::vector<RecordJudgement>& parts) {
  if (parts.empty()) return "";
  const std::string steps = std::to_string(parts.front().steps);
  std::vector<Row> rows{{"output", "rows", "model", "1-step VAF %", "fit %", "RMSE",
                         "free-run VAF %", "fit %", "RMSE", steps + "-step RMSE",
                         "in 95 % interval", "samples"}};
  for (std::size_t i = 0; i < parts.front().outputs.size(); ++i)
    for (const auto& part : parts) {
      const OutputJudgement& o = part.outputs[i];
      std::string label = o.output + (o.unit.empty() ? "" : " [" + o.unit + "]");
      std::string title = part.title;
      for (const auto& f : o.kinds) {
        rows.push_back(rowOf(o, f, label, title));
        label.clear();
        title.clear();
      }
    }
  std::string text =
      alignedTable(rows) +
      "(RMSE in the unit of the output; * chosen; laws: what control laws take; free runs "
      "start from the first samples" +
      (parts.front().reach > 0 ? " and anew after every " + std::to_string(parts.front().reach)
                               : "") +
      ")\n\n";
  std::vector<Row> residuals{{"residuals of", "rows", "correlations outside %", "bound"}};
  for (const auto& part : parts)
    for (const auto& o : part.outputs)
      residuals.push_back(
          {o.output, part.title, fixed(100.0 * o.residual.outside), shortText(o.residual.bound)});
  return text + alignedTable(residuals);
}

Json toJson(const RecordJudgement& part) {
  Json tree = Json::object(), linear = Json::object();
  for (const auto& o : part.outputs) {
    const KindFigures& best = bestFigures(o);
    Json& output = tree[o.output] = toJson(best);
    output["best"] = name(o.best);
    output["ahead"] = figuresJson(o.ahead);
    output["ahead"]["steps"] = part.steps;
    output["laws"] = {{"kind", name(o.laws)}, {"ahead", figuresJson(o.laws_ahead)}};
    if (const KindFigures* laws = figuresOf(o, o.laws)) output["laws"].update(toJson(*laws));
    for (const auto& f : o.kinds) {
      output[name(f.kind)] = toJson(f);
      if (f.kind == ModelKind::kLinear) linear[o.output] = toJson(f);
    }
    output["residual"] = {{"bound", numberOrNull(o.residual.bound)},
                          {"outside", numberOrNull(o.residual.outside)}};
    output["interval"] = intervalJson(best);
  }
  if (!linear.empty()) tree["linear"] = linear;
  return tree;
}

}  // namespace fpc::tool
