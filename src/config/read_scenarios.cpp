// What tuning files and study files share: fitness, changes of a loop, scenarios.
#include "config/read_scenarios.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "config/fitness_index.hpp"
#include "config/read.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

/// The key of a term that names its signal.
std::string signalKey(const std::string& index) {
  switch (kindOf(index)) {
    case IndexOf::kOutput:
    case IndexOf::kStep:
      return "output";
    case IndexOf::kInput:
      return "input";
    case IndexOf::kConsumption:
      return "name";
    case IndexOf::kRun:
    case IndexOf::kEffluent:
      break;
  }
  return "";
}

FitnessTerm readTerm(YamlSection& item, bool of_tuning) {
  FitnessTerm term;
  need(item, "index", "one of " + join(fitnessIndices()));
  item.oneOf("index", term.index, fitnessIndices());
  item.number("weight", term.weight, kFiniteNotNegative);
  item.number("above", term.above, {-kInfinity, kInfinity, true});
  if (of_tuning) item.text("scenario", term.scenario);
  const std::string key = signalKey(term.index);
  if (!key.empty()) item.text(key, term.signal);
  item.finish();
  return term;
}

TuningScenario readScenario(YamlSection& item) {
  TuningScenario scenario;
  item.text("name", scenario.name);
  item.text("loop", scenario.loop);
  scenario.has_seed = item.has("seed");
  item.seed("seed", scenario.seed);
  scenario.set = readSet(item);
  scenario.vary = readVariations(item);
  if (!scenario.vary.empty() && !scenario.has_seed) item.fail("vary", "a seed, which draws them");
  item.finish();
  checked(item, [&] { checkVariations(scenario.vary); });
  return scenario;
}

/// {seeds: 1:8, vary: {...}}: one for each seed.
std::vector<TuningScenario> readSeeded(YamlSection section) {
  std::vector<TuningScenario> scenarios;
  TuningScenario scenario;
  scenario.has_seed = true;
  scenario.vary = readVariations(section);
  checked(section, [&] { checkVariations(scenario.vary); });
  for (const std::uint64_t seed : readSeeds(section)) {
    scenario.seed = seed;
    scenarios.push_back(scenario);
  }
  section.finish();
  return scenarios;
}

std::string nameOf(const TuningScenario& scenario, std::size_t number) {
  if (!scenario.name.empty()) return scenario.name;
  if (scenario.has_seed) return "seed " + std::to_string(scenario.seed);
  return scenario.loop.empty() ? "scenario " + std::to_string(number) : scenario.loop;
}

}  // namespace

FitnessParams readFitness(YamlSection& root, bool of_tuning) {
  FitnessParams fitness;
  YamlSection section = root.section("fitness");
  for (auto& item : section.list("terms")) fitness.terms.push_back(readTerm(item, of_tuning));
  if (fitness.terms.empty()) section.fail("terms", "a list of at least one {index, ...}");
  if (std::none_of(fitness.terms.begin(), fitness.terms.end(),
                   [](const FitnessTerm& term) { return term.weight > 0.0; }))
    section.fail("terms", "at least one term with a weight > 0");
  section.number("band", fitness.band, kFinitePositive);
  section.oneOf("time_unit", fitness.time_unit, {"s", "min", "h"});
  if (of_tuning) {
    readOption(section, "across", fitness.across);
    section.boolean("relative", fitness.relative);
    section.number("failure", fitness.failure, {0.0, kInfinity, true});
  }
  section.finish();
  return fitness;
}

Overrides readSet(YamlSection& section) {
  Overrides set;
  const YAML::Node node = section.raw("set");
  if (node.IsDefined() && !node.IsMap()) section.fail("set", "a mapping of key.path: value");
  for (const auto& entry : node) {
    YAML::Emitter text;
    text << YAML::Flow << entry.second;
    set.emplace_back(entry.first.Scalar(), text.c_str());
  }
  return set;
}

std::vector<TuningScenario> readScenarios(YamlSection& root, const std::string& key) {
  std::vector<TuningScenario> scenarios;
  const YAML::Node node = root.raw(key);
  if (!node.IsDefined()) return scenarios;
  if (node.IsMap()) {
    scenarios = readSeeded(root.section(key));
  } else {
    for (auto& item : root.list(key)) scenarios.push_back(readScenario(item));
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    scenarios[i].name = nameOf(scenarios[i], i + 1);
    if (!names.insert(scenarios[i].name).second)
      root.fail(key, "scenarios with names of their own; twice " + scenarios[i].name);
  }
  return scenarios;
}

}  // namespace fpc
