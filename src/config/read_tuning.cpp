// Reader of tuning files.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/config/tuning_file.hpp"
#include "fmbpc/study/fitness.hpp"

namespace fpc {
namespace {

TuningParameter readParameter(YamlSection& item) {
  TuningParameter parameter;
  std::string scale = "linear";
  need(item, "key", "a path in the loop file, as --set takes it");
  item.text("key", parameter.key);
  item.oneOf("scale", scale, {"linear", "log"});
  parameter.logarithmic = scale == "log";
  item.boolean("integer", parameter.integer);
  need(item, "lower", "a number");
  need(item, "upper", "a number");
  item.number("lower", parameter.lower, parameter.logarithmic ? kFinitePositive : kFinite);
  item.number("upper", parameter.upper, {parameter.lower, kLargest, true});
  item.number("start", parameter.start, {parameter.lower, parameter.upper});
  item.finish();
  return parameter;
}

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
      break;
  }
  return "";
}

FitnessTerm readTerm(YamlSection& item) {
  FitnessTerm term;
  need(item, "index", "one of " + join(fitnessIndices()));
  item.oneOf("index", term.index, fitnessIndices());
  item.number("weight", term.weight, kFiniteNotNegative);
  const std::string key = signalKey(term.index);
  if (!key.empty()) item.text(key, term.signal);
  item.finish();
  return term;
}

FitnessParams readFitness(YamlSection& root) {
  FitnessParams fitness;
  YamlSection section = root.section("fitness");
  for (auto& item : section.list("terms")) fitness.terms.push_back(readTerm(item));
  if (fitness.terms.empty()) section.fail("terms", "a list of at least one {index, ...}");
  section.number("band", fitness.band, kFinitePositive);
  section.oneOf("time_unit", fitness.time_unit, {"s", "min", "h"});
  section.oneOf("across", fitness.across, {"mean", "median", "worst"});
  section.boolean("relative", fitness.relative);
  section.number("failure", fitness.failure, {0.0, kInfinite, true});
  section.finish();
  return fitness;
}

/// Under `set`: changes of the loop as --set makes them.
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

TuningScenario readScenario(YamlSection& item) {
  TuningScenario scenario;
  item.text("name", scenario.name);
  item.text("loop", scenario.loop);
  scenario.has_seed = item.has("seed");
  item.seed("seed", scenario.seed);
  scenario.set = readSet(item);
  item.finish();
  return scenario;
}

std::string nameOf(const TuningScenario& scenario, std::size_t number) {
  if (!scenario.name.empty()) return scenario.name;
  if (scenario.has_seed) return "seed " + std::to_string(scenario.seed);
  return scenario.loop.empty() ? "scenario " + std::to_string(number) : scenario.loop;
}

/// Under `key`: a list of scenarios, or {seeds: [...]}.
std::vector<TuningScenario> readScenarios(YamlSection& root, const std::string& key) {
  std::vector<TuningScenario> scenarios;
  const YAML::Node node = root.raw(key);
  if (!node.IsDefined()) return scenarios;
  if (node.IsMap()) {
    YamlSection section = root.section(key);
    std::vector<double> seeds;
    section.numbers("seeds", seeds, kFiniteNotNegative);
    section.finish();
    for (const double seed : seeds) {
      if (seed != std::floor(seed)) root.fail(key, "whole numbers as seeds");
      TuningScenario scenario;
      scenario.has_seed = true;
      scenario.seed = static_cast<std::uint64_t>(seed);
      scenarios.push_back(scenario);
    }
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

void readSearch(YamlSection& root, SearchParams& search) {
  YamlSection section = root.section("search");
  section.text("method", search.method);
  section.integer("population", search.population, 1);
  section.integer("evaluations", search.evaluations, 1);
  section.seed("seed", search.seed);
  section.number("cognitive", search.cognitive, kFiniteNotNegative);
  section.number("social", search.social, kFiniteNotNegative);
  section.number("speed_upper", search.speed_upper, {0.0, 1.0, true});
  section.number("inertia", search.inertia, kFiniteNotNegative);
  section.number("inertia_start", search.inertia_start, kFiniteNotNegative);
  section.number("inertia_end", search.inertia_end, kFiniteNotNegative);
  section.number("differential_weight", search.differential_weight, {0.0, 1.0});
  section.number("crossover", search.crossover, {0.0, 1.0});
  section.integer("variant", search.variant, 1, 10);
  section.number("step", search.step, kFinitePositive);
  section.finish();
  checked(section, [&] { search.validate(); });
}

}  // namespace

double TuningParameter::value(double part) const {
  const double from = logarithmic ? std::log(lower) : lower;
  const double to = logarithmic ? std::log(upper) : upper;
  const double scaled = from + part * (to - from);
  const double plain = logarithmic ? std::exp(scaled) : scaled;
  return std::clamp(integer ? std::round(plain) : plain, lower, upper);
}

double TuningParameter::share(double number) const {
  const double inside = std::clamp(number, lower, upper);
  if (logarithmic) return std::log(inside / lower) / std::log(upper / lower);
  return (inside - lower) / (upper - lower);
}

TuningFile parseTuning(const std::string& text, const std::string& file) {
  YamlSection root = YamlSection::parse(text, file);
  TuningFile tuning;
  tuning.file = file;
  tuning.text = text;
  root.text("title", tuning.title);
  tuning.set = readSet(root);
  std::set<std::string> keys;
  for (auto& item : root.list("parameters")) {
    tuning.parameters.push_back(readParameter(item));
    if (!keys.insert(tuning.parameters.back().key).second) item.fail("key", "every key only once");
  }
  if (tuning.parameters.empty())
    root.fail("parameters", "a list of at least one {key, lower, upper}");
  tuning.fitness = readFitness(root);
  tuning.scenarios = readScenarios(root, "scenarios");
  if (tuning.scenarios.empty()) {
    tuning.scenarios.emplace_back();
    tuning.scenarios.back().name = "as it is";
  }
  tuning.held_out = readScenarios(root, "held_out");
  readSearch(root, tuning.search);
  root.finish();
  return tuning;
}

TuningFile readTuning(const std::string& name_or_path) {
  const std::string file = findTuning(name_or_path);
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  std::stringstream text;
  text << stream.rdbuf();
  return parseTuning(text.str(), file);
}

}  // namespace fpc
