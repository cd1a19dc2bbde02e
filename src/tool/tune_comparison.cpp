// fmbpc tune --compare: every method with every seed at equal evaluations.
#include <algorithm>
#include <filesystem>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "base/statistics.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "tool/progress_bar.hpp"
#include "tool/tune_report.hpp"

namespace fpc::tool {
namespace {

namespace fs = std::filesystem;
using Json = OrderedJson;

std::vector<double> sorted(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list) values.push_back(numberOrInfinity(value));
  std::sort(values.begin(), values.end());
  return values;
}

Json curveOf(const TuneResult& result) {
  Json curve = Json::array();
  double best = kInfinity;
  for (const auto& step : result.history) {
    best = std::min(best, step.cost);
    curve.push_back(numberOrNull(best));
  }
  return curve;
}

/// Whether there is a state to go on from, as the process sees it that leads.
bool hasState(RunPool& pool, const std::string& state) {
  RunPool::Texts there(1);
  if (pool.leads()) there[0] = fs::exists(state) || fs::exists(state + ".runs") ? "yes" : "no";
  pool.fill(there, {}, {}, {});
  return there[0] == "yes";
}

/// One run; false if it was stopped.
bool addRun(const TuningObjective& objective, const CompareOptions& options,
            const SearchParams& search, Json& method) {
  TuneOptions one;
  one.stop = [] { return interruption().load(); };
  if (!options.out.empty()) {
    one.state = (fs::path(options.out) /
                 (wordOf(search.method) + "_" + std::to_string(search.seed) + ".state.json"))
                    .string();
    one.resume = options.resume && hasState(objective.pool(), one.state);
  }
  ProgressBar bar(wordOf(search.method) + " " + std::to_string(search.seed));
  one.progress = [&](int n, double best) {
    bar.show(static_cast<double>(n) / search.evaluations, "cost " + shortText(best));
  };
  const TuneResult result = tune(objective, search, one);
  if (result.stopped) return false;
  const bool found = result.best >= 0;
  const TuningStep* best = found ? &result.history[static_cast<std::size_t>(result.best)] : nullptr;
  method["costs"].push_back(found ? numberOrNull(best->cost) : Json(nullptr));
  if (!objective.tuning().held_out.empty()) {
    const auto held = found ? objective.judgeHeldOut(best->shares, one.stop) : std::nullopt;
    if (found && !held) return false;
    method["held_out"].push_back(held ? numberOrNull(held->cost) : Json(nullptr));
  }
  method["values"].push_back(found ? Json(best->values) : Json(nullptr));
  method["failures"].push_back(result.failures);
  method["seconds"].push_back(result.seconds);
  method["evaluations"].push_back(result.history.size());
  method["curves"].push_back(curveOf(result));
  return true;
}

Json summaryOf(const Json& list) {
  const auto values = sorted(list);
  return {{"median", numberOrNull(median(values))},
          {"best", numberOrNull(values.front())},
          {"worst", numberOrNull(values.back())}};
}

}  // namespace

Json compareMethods(const TuningObjective& objective, const CompareOptions& options) {
  Json comparison{{"loop", options.loop},
                  {"tuning", fs::path(objective.tuning().file).stem().string()},
                  {"title", objective.tuning().title},
                  {"evaluations", options.search.evaluations},
                  {"population", options.search.population},
                  {"parameters", objective.size()},
                  {"seeds", options.seeds},
                  {"threads", objective.pool().width()},
                  {"complete", false},
                  {"before", numberOrNull(objective.untouched().cost)}};
  const bool has_held_out = !objective.tuning().held_out.empty();
  if (has_held_out) comparison["held_out_before"] = numberOrNull(objective.untouchedHeldOut().cost);
  comparison["methods"] = Json::array();
  for (const auto& name : options.methods) {
    Json method{{"method", name}};
    SearchParams search = options.search;
    search.method = searchMethod(name);
    for (int i = 0; i < options.seeds; ++i, ++search.seed)
      if (!addRun(objective, options, search, method)) return comparison;
    method["cost"] = summaryOf(method["costs"]);
    if (has_held_out) method["held_out_cost"] = summaryOf(method["held_out"]);
    comparison["methods"].push_back(method);
  }
  comparison["complete"] = true;
  return comparison;
}

std::string comparisonTable(const Json& comparison) {
  const bool has_held_out = comparison.contains("held_out_before");
  std::vector<std::vector<std::string>> rows{{"method", "median", "best", "worst", "held out"}};
  const auto cell = [](const Json& value) { return shortText(numberOrInfinity(value)); };
  rows.push_back({"untouched", cell(comparison["before"]), "", "",
                  has_held_out ? cell(comparison["held_out_before"]) : "-"});
  for (const Json& method : comparison["methods"]) {
    const Json& cost = method["cost"];
    rows.push_back({method["method"], cell(cost["median"]), cell(cost["best"]), cell(cost["worst"]),
                    has_held_out ? cell(method["held_out_cost"]["median"]) : "-"});
  }
  return comparison["loop"].get<std::string>() + ", " +
         std::to_string(comparison["evaluations"].get<int>()) + " evaluations, " +
         std::to_string(comparison["seeds"].get<int>()) + " seeds\n" + alignedTable(rows);
}

}  // namespace fpc::tool
