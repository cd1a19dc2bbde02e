#include <cmath>

#include "base/ordered_json.hpp"
#include "tool/figures_json.hpp"
#include "tool/identify_report.hpp"
#include "tool/model_points.hpp"

namespace fpc::tool {
namespace {

using Json = OrderedJson;

Json finite(double value) { return numberOrNull(value); }
Json toJson(const FitFigures& figures) { return figuresJson(figures); }

/// <output>.{one_step, free_run, linear.{..}, residual} and linear.<output>.{one_step, free_run}.
Json toJson(const JudgedRecord& judged) {
  Json tree = Json::object();
  for (const auto& v : judged.outputs) {
    const Json one_step = toJson(v.linear_one_step), free_run = toJson(v.linear_free_run);
    Json& output = tree[v.output];
    output["one_step"] = toJson(v.one_step);
    output["free_run"] = toJson(v.free_run);
    output["linear"]["one_step"] = one_step;
    output["linear"]["free_run"] = free_run;
    output["residual"] = {{"bound", finite(v.residual.bound)},
                          {"outside", finite(v.residual.outside)}};
  }
  for (const auto& v : judged.outputs) {
    tree["linear"][v.output]["one_step"] = toJson(v.linear_one_step);
    tree["linear"][v.output]["free_run"] = toJson(v.linear_free_run);
  }
  return tree;
}

Json trialsOf(const OutputIdentification& found) {
  Json trials = Json::array();
  for (const auto& t : found.trials)
    trials.push_back({{"clusters", t.clusters},
                      {"xie_beni", finite(t.validity.xie_beni)},
                      {"partition_density", finite(t.validity.partition_density)},
                      {"partition_coefficient", finite(t.validity.partition_coefficient)},
                      {"one_step_rmse", finite(t.one_step_rmse)},
                      {"free_run_rmse", finite(t.free_run_rmse)},
                      {"spread", finite(t.spread)}});
  return trials;
}

Json dynamicsOf(const RuleDynamics& dynamics) {
  Json poles = Json::array(), gains = Json::object();
  for (const auto& pole : dynamics.poles)
    poles.push_back({finite(pole.real()), finite(pole.imag())});
  for (std::size_t i = 0; i < dynamics.signals.size(); ++i)
    gains[dynamics.signals[i]] = finite(dynamics.gains[i]);
  return {{"poles", poles}, {"gains", gains}};
}

/// Rules as found; dropped ones have no dynamics.
Json rulesOf(const OutputIdentification& found, const std::vector<RuleDynamics>& all) {
  static const char* const statuses[] = {"fitted", "borrowed", "dropped"};
  Json rules = Json::array();
  std::size_t kept = 0;
  for (const auto& fit : found.rules) {
    Json rule{{"status", statuses[static_cast<std::size_t>(fit.status)]},
              {"data_count", fit.samples},
              {"evidence", finite(fit.evidence)},
              {"condition", finite(fit.condition)}};
    if (fit.status != RuleStatus::kDropped) {
      ++kept;
      for (const auto& dynamics : all)
        if (dynamics.output == found.output && dynamics.rule == kept)
          rule.update(dynamicsOf(dynamics));
    }
    rules.push_back(rule);
  }
  return rules;
}

}  // namespace

std::string toJson(const IdentifyReport& report) {
  const auto dynamics = ruleDynamics(report.found.model);
  Json json{{"name", report.found.model.name}, {"source", report.found.model.source}};
  json["identification"] = toJson(report.identification);
  json["validation"] = report.validation ? toJson(*report.validation) : Json(nullptr);
  for (const char* key : {"rules", "rule_details", "trials"}) json[key] = Json::object();
  for (std::size_t i = 0; i < report.found.outputs.size(); ++i) {
    const OutputIdentification& found = report.found.outputs[i];
    json["rules"][found.output] = report.found.model.submodels[i].rules.size();
    json["rule_details"][found.output] = rulesOf(found, dynamics);
    if (!found.trials.empty()) json["trials"][found.output] = trialsOf(found);
  }
  json["points"] = pointsJson(report.found.model);
  json["remarks"] = report.remarks;
  json["seconds"] = report.seconds;
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fpc::tool
