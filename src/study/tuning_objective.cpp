#include "study/tuning_objective.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>

#include "base/finite_json.hpp"
#include "base/ordered_json.hpp"
#include "base/statistics.hpp"
#include "base/text_hash.hpp"
#include "config/extending_loop.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/run.hpp"
#include "study/fitness.hpp"
#include "study/loop_contents.hpp"
#include "study/seeded_loop.hpp"

namespace fpc {
namespace {

using Json = OrderedJson;

/// What a scenario's seed changes.
Overrides seedOverrides(const std::string& loop, const TuningScenario& scenario,
                        const Overrides& set) {
  if (!scenario.has_seed) return {};
  const LoopFile read = readLoop(loop, set);
  Overrides seeds;
  for (const auto& key : seededKeys(read, read.simulation.noise_std.any()))
    seeds.emplace_back(key, std::to_string(scenario.seed));
  const auto drawn = drawnBy(scenario.seed, scenario.vary);
  for (std::size_t v = 0; v < drawn.size(); ++v)
    seeds.emplace_back(scenario.vary[v].key, exactText(unitOf(scenario.vary[v], read) * drawn[v]));
  require(!seeds.empty(), "scenario " + scenario.name + ": seed",
          "a loop with a disturbance pattern, noise or vary: " + read.name);
  return seeds;
}

/// Without the terms of other scenarios.
FitnessParams fitnessIn(FitnessParams fitness, const std::string& scenario) {
  auto& terms = fitness.terms;
  terms.erase(std::remove_if(terms.begin(), terms.end(),
                             [&](const FitnessTerm& term) {
                               return !term.scenario.empty() && term.scenario != scenario;
                             }),
              terms.end());
  return fitness;
}

}  // namespace

TuningObjective::TuningObjective(const std::string& loop, TuningFile tuning, const Overrides& set,
                                 int threads)
    : TuningObjective(loop, std::move(tuning), set, std::make_shared<ThreadPool>(threads)) {}

TuningObjective::TuningObjective(const std::string& loop, TuningFile tuning, const Overrides& set,
                                 std::shared_ptr<RunPool> pool)
    : tuning_(std::move(tuning)), set_(tuning_.set), pool_(std::move(pool)) {
  set_.insert(set_.end(), set.begin(), set.end());
  cases_ = casesOf(loop, tuning_.scenarios);
  held_out_ = casesOf(loop, tuning_.held_out);
  own_ = ownValues();
  start_ = startOf();
  std::string all = tuning_.text;
  for (const auto* cases : {&cases_, &held_out_})
    for (const auto& scenario : *cases) {
      const LoopFile first = parseLoop(scenario.text, scenario.name, valueOverrides(start_));
      checkFitness(scenario.fitness, first);
      all += scenario.text + contentsOf(first);
    }
  fingerprint_ = textHash(all);
  judgeUntouched(cases_, untouched_);
  if (!held_out_.empty()) judgeUntouched(held_out_, untouched_held_out_);
}

std::vector<TuningObjective::Case> TuningObjective::casesOf(
    const std::string& loop, const std::vector<TuningScenario>& scenarios) {
  std::vector<Case> cases;
  for (const auto& scenario : scenarios) {
    const std::string name = scenario.loop.empty() ? loop : scenario.loop;
    Overrides overrides = set_;
    overrides.insert(overrides.end(), scenario.set.begin(), scenario.set.end());
    const Overrides seeds = seedOverrides(name, scenario, overrides);
    overrides.insert(overrides.end(), seeds.begin(), seeds.end());
    cases.push_back({std::filesystem::path(findLoop(name)).stem().string(),
                     resolveLoop(name, overrides), fitnessIn(tuning_.fitness, scenario.name), 1.0});
  }
  return cases;
}

std::vector<double> TuningObjective::ownValues() const {
  std::vector<double> values;
  for (const TuningParameter& parameter : tuning_.parameters) {
    const std::string text = scalarOf(cases_.front().text, parameter.key);
    char* end = nullptr;
    const double own = std::strtod(text.c_str(), &end);
    const bool is_number = !text.empty() && *end == '\0' && std::isfinite(own);
    values.push_back(is_number ? own : std::nan(""));
  }
  return values;
}

Vector TuningObjective::startOf() const {
  Vector start(size());
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const TuningParameter& parameter = tuning_.parameters[k];
    const double value = std::isnan(parameter.start) ? own_[k] : parameter.start;
    start[i] = std::isnan(value) ? 0.5 : parameter.share(value);
  }
  return start;
}

std::vector<double> TuningObjective::values(const Vector& shares) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < tuning_.parameters.size(); ++i)
    values.push_back(tuning_.parameters[i].value(shares[static_cast<Eigen::Index>(i)]));
  return values;
}

Overrides TuningObjective::valueOverrides(const Vector& shares) const {
  Overrides overrides;
  const auto numbers = values(shares);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const TuningParameter& parameter = tuning_.parameters[i];
    overrides.emplace_back(parameter.key, parameter.integer
                                              ? std::to_string(std::llround(numbers[i]))
                                              : exactText(numbers[i]));
  }
  return overrides;
}

Overrides TuningObjective::changes(const Vector& shares) const {
  Overrides all = set_;
  const Overrides own = valueOverrides(shares);
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

TuningObjective::Run TuningObjective::run(const Case& scenario, const Overrides& changes,
                                          const Stop& stop) const {
  Run result;
  result.cost = kInfinity;
  RunOptions options;
  options.stop = [&] { return result.stopped = result.stopped || (stop && stop()); };
  if (options.stop()) return result;
  try {
    const LoopFile loop = parseLoop(scenario.text, scenario.name, changes);
    const RunRecord record = runLoop(loop, options);
    result.cost = fitness(scenario.fitness, loop, record) / scenario.scale;
    if (!std::isfinite(result.cost))
      result.trouble = scenario.name + ": " +
                       (record.trouble.empty() ? "the cost is not finite" : record.trouble);
  } catch (const std::exception& e) {
    result.trouble = scenario.name + ": " + e.what();
  }
  return result;
}

TuningScore TuningObjective::scoreOf(const std::vector<Run>& runs, std::size_t first,
                                     std::size_t count) const {
  TuningScore score;
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) {
    const double cost = std::min(runs[i].cost, tuning_.fitness.failure);
    score.scenarios.push_back(cost);
    sum += cost;
    score.failures += !runs[i].trouble.empty();
    if (score.trouble.empty()) score.trouble = runs[i].trouble;
  }
  const AcrossScenarios across = tuning_.fitness.across;
  if (across == AcrossScenarios::kWorst)
    score.cost = *std::max_element(score.scenarios.begin(), score.scenarios.end());
  else if (across == AcrossScenarios::kMedian)
    score.cost = median(score.scenarios);
  else
    score.cost = sum / static_cast<double>(count);
  return score;
}

std::string TuningObjective::textOf(const Run& run) {
  return Json{{"cost", numberOrNull(run.cost)}, {"trouble", run.trouble}}.dump();
}

TuningObjective::Run TuningObjective::runOf(const std::optional<std::string>& text) {
  Run run;
  run.cost = kInfinity;
  run.stopped = !text;
  if (!text) return run;
  const Json json = Json::parse(*text);
  if (!json.at("cost").is_null()) run.cost = json.at("cost");
  run.trouble = json.at("trouble");
  return run;
}

std::vector<TuningObjective::Run> TuningObjective::runAll(const std::vector<Case>& cases,
                                                          const std::vector<Overrides>& changes,
                                                          const Stop& stop, RunPool::Texts known,
                                                          const RunPool::Done& done) const {
  known.resize(changes.size() * cases.size());
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i]) order.push_back(i);
  const auto work = [&](std::size_t i) -> std::optional<std::string> {
    const Run made = run(cases[i % cases.size()], changes[i / cases.size()], stop);
    if (made.stopped) return std::nullopt;
    return textOf(made);
  };
  pool_->fill(known, order, work, done);
  std::vector<Run> runs;
  for (const auto& text : known) runs.push_back(runOf(text));
  return runs;
}

std::optional<std::vector<TuningScore>> TuningObjective::judge(
    const std::vector<Case>& cases, const std::vector<Overrides>& changes, const Stop& stop,
    RunPool::Texts known, const RunPool::Done& done) const {
  const std::vector<Run> runs = runAll(cases, changes, stop, std::move(known), done);
  if (std::any_of(runs.begin(), runs.end(), [](const Run& r) { return r.stopped; }))
    return std::nullopt;
  std::vector<TuningScore> scores;
  for (std::size_t p = 0; p < changes.size(); ++p)
    scores.push_back(scoreOf(runs, p * cases.size(), cases.size()));
  return scores;
}

std::optional<std::vector<TuningScore>> TuningObjective::judge(const Matrix& points,
                                                               const Stop& stop,
                                                               RunPool::Texts known,
                                                               const RunPool::Done& done) const {
  std::vector<Overrides> all;
  for (Eigen::Index p = 0; p < points.cols(); ++p) all.push_back(valueOverrides(points.col(p)));
  return judge(cases_, all, stop, std::move(known), done);
}

std::optional<TuningScore> TuningObjective::judgeHeldOut(const Vector& point,
                                                         const Stop& stop) const {
  const auto scores = judge(held_out_, {valueOverrides(point)}, stop, {}, {});
  if (!scores) return std::nullopt;
  return scores->front();
}

void TuningObjective::judgeUntouched(std::vector<Case>& cases, TuningScore& untouched) const {
  if (tuning_.fitness.relative) {
    const std::vector<Run> runs = runAll(cases, {Overrides{}}, {}, {}, {});
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const bool usable = std::isfinite(runs[i].cost) && runs[i].cost > 0.0;
      require(usable, tuning_.file + ": fitness.relative",
              "an untouched loop with a finite cost > 0 in every scenario" +
                  (runs[i].trouble.empty() ? "" : " (" + runs[i].trouble + ")"));
      cases[i].scale = runs[i].cost;
    }
  }
  untouched = judge(cases, {Overrides{}}, {}, {}, {})->front();
}

}  // namespace fpc
