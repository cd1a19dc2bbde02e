#include "tool/tune_report.hpp"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "base/files.hpp"
#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "config/extending_loop.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;
using TuneRows = std::vector<std::vector<std::string>>;

std::vector<double> valuesAfter(const TunedLoop& tuned) {
  return tuned.result.history[static_cast<std::size_t>(tuned.result.best)].values;
}

double costAfter(const TunedLoop& tuned) {
  return tuned.result.history[static_cast<std::size_t>(tuned.result.best)].cost;
}

Json scoresJson(const std::vector<TuningScenario>& scenarios, double cost,
                const std::vector<double>& costs) {
  Json json{{"cost", numberOrNull(cost)}, {"scenarios", Json::object()}};
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    json["scenarios"][scenarios[i].name] = numberOrNull(costs[i]);
  return json;
}

Json parametersJson(const TuningObjective& objective, const TunedLoop& tuned) {
  Json list = Json::array();
  const auto start = objective.values(objective.start());
  const bool found = nothingFound(objective, tuned.result).empty();
  const auto& own = objective.own();
  for (std::size_t i = 0; i < own.size(); ++i) {
    const TuningParameter& p = objective.tuning().parameters[i];
    Json parameter{{"key", p.key},
                   {"lower", p.lower},
                   {"upper", p.upper},
                   {"scale", p.logarithmic ? "log" : "linear"},
                   {"before", numberOrNull(own[i])},
                   {"start", start[i]}};
    if (tuned.result.best >= 0) {
      parameter["value"] = valuesAfter(tuned)[i];
      const std::string bound = boundOf(p, valuesAfter(tuned)[i]);
      if (!bound.empty() && found) parameter["at_bound"] = bound;
    }
    list.push_back(parameter);
  }
  return list;
}

void addScores(TuneRows& rows, const std::string& title,
               const std::vector<TuningScenario>& scenarios, const TuningScore& before,
               const TuningScore& after) {
  const auto ratio = [](double b, double a) { return shortText(a / b); };
  for (std::size_t i = 0; i < scenarios.size(); ++i)
    rows.push_back({"  " + scenarios[i].name, shortText(before.scenarios[i]),
                    shortText(after.scenarios[i]), ratio(before.scenarios[i], after.scenarios[i])});
  rows.push_back(
      {title, shortText(before.cost), shortText(after.cost), ratio(before.cost, after.cost)});
}

/// What untouched() was judged with.
std::string ownText(const TuningParameter& parameter, double own) {
  if (std::isnan(own)) return "-";
  return shortText(own) + (isOutside(parameter, own) ? " (outside)" : "");
}

}  // namespace

Json toJson(const TuningObjective& objective, const TunedLoop& tuned) {
  const TuneResult& result = tuned.result;
  const TuningFile& tuning = objective.tuning();
  const double fresh = static_cast<double>(result.history.size());
  Json json{{"loop", tuned.loop},
            {"tuning", fs::path(tuning.file).stem().string()},
            {"title", tuning.title},
            {"method", wordOf(result.search.method)},
            {"seed", result.search.seed},
            {"population", result.search.population},
            {"budget", result.search.evaluations},
            {"evaluations", result.history.size()},
            {"generations", result.generations},
            {"resumed", result.resumed},
            {"complete", !result.stopped},
            {"threads", objective.pool().width()},
            {"seconds", result.seconds},
            {"evaluations_per_s", numberOrNull(fresh / result.seconds)},
            {"failures", result.failures},
            {"trouble", result.trouble},
            {"worse", !worsening(objective, tuned).empty()},
            {"parameters", parametersJson(objective, tuned)},
            {"remarks", remarksOf(objective, tuned)}};
  const TuningScore& before = objective.untouched();
  json["before"] = scoresJson(tuning.scenarios, before.cost, before.scenarios);
  if (result.best >= 0)
    json["after"] = scoresJson(tuning.scenarios, costAfter(tuned),
                               result.history[static_cast<std::size_t>(result.best)].scenarios);
  if (tuned.held_out) {
    const TuningScore& held = objective.untouchedHeldOut();
    json["held_out"] = {
        {"before", scoresJson(tuning.held_out, held.cost, held.scenarios)},
        {"after", scoresJson(tuning.held_out, tuned.held_out->cost, tuned.held_out->scenarios)}};
  }
  return json;
}

std::string toTable(const TuningObjective& objective, const TunedLoop& tuned) {
  const TuningFile& tuning = objective.tuning();
  const TuneResult& result = tuned.result;
  const std::string verdict = verdictOf(objective, tuned);
  std::ostringstream text;
  if (!verdict.empty()) text << verdict << "\n\n";
  text << tuned.loop << ", " << wordOf(result.search.method) << ", seed " << result.search.seed
       << ": " << result.history.size() << " evaluations of " << tuning.scenarios.size()
       << (tuning.scenarios.size() == 1 ? " run" : " runs") << " in " << shortText(result.seconds)
       << " s\n\n";
  if (result.failures > 0)
    text << result.failures << " runs failed; the first: " << result.trouble << "\n\n";
  if (result.best < 0) return text.str() + "no run succeeded\n";
  TuneRows rows{{"parameter", "before", "after", "lower", "upper"}};
  const auto after = valuesAfter(tuned);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const TuningParameter& p = tuning.parameters[i];
    rows.push_back({p.key, ownText(p, objective.own()[i]), shortText(after[i]), shortText(p.lower),
                    shortText(p.upper)});
  }
  text << alignedTable(rows) << "\n";
  TuningScore tuned_score;
  tuned_score.cost = costAfter(tuned);
  tuned_score.scenarios = result.history[static_cast<std::size_t>(result.best)].scenarios;
  TuneRows scores{{"cost", "before", "after", "after/before"}};
  addScores(scores, "tuned on: " + wordOf(tuning.fitness.across), tuning.scenarios,
            objective.untouched(), tuned_score);
  if (tuned.held_out)
    addScores(scores, "held out: " + wordOf(tuning.fitness.across), tuning.held_out,
              objective.untouchedHeldOut(), *tuned.held_out);
  text << alignedTable(scores);
  std::string remarks;
  for (const auto& remark : remarksOf(objective, tuned))
    if (remark != verdict) remarks += "\n" + remark;
  return text.str() + remarks + (remarks.empty() ? "" : "\n");
}

std::string writeTunedLoop(const TuningObjective& objective, const TunedLoop& tuned,
                           const std::string& folder) {
  const TuneResult& result = tuned.result;
  const std::string stem = fs::path(findLoop(tuned.loop)).stem().string();
  const TuningStep& best = result.history[static_cast<std::size_t>(result.best)];
  std::string comment =
      "Tuned by `fmbpc tune " + stem + " " + fs::path(objective.tuning().file).stem().string() +
      "`, " + wordOf(result.search.method) + ", seed " + std::to_string(result.search.seed) + ", " +
      std::to_string(result.history.size()) + " evaluations.\nCost " +
      shortText(objective.untouched().cost) + " -> " + shortText(best.cost);
  if (tuned.held_out)
    comment += ", held out " + shortText(objective.untouchedHeldOut().cost) + " -> " +
               shortText(tuned.held_out->cost);
  for (const auto& remark : remarksOf(objective, tuned)) comment += ".\n" + remark;
  const std::string title = readLoop(tuned.loop).report.title + ", tuned";
  const std::string file = inFolder(folder, stem + "_tuned.yaml");
  writeText(extendingLoop(tuned.loop, objective.changes(best.shares), title, comment + "."), file);
  return file;
}

}  // namespace fpc::tool
