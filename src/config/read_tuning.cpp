// Reader of tuning files.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "config/read_scenarios.hpp"
#include "config/tuning_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

TuningParameter readParameter(YamlSection& item) {
  TuningParameter parameter;
  need(item, "key", "a path in the loop file, as --set takes it");
  item.text("key", parameter.key);
  readOption(item, "scale", parameter.logarithmic, {{"linear", false}, {"log", true}});
  item.boolean("integer", parameter.integer);
  need(item, "lower", "a number");
  need(item, "upper", "a number");
  item.number("lower", parameter.lower, parameter.logarithmic ? kFinitePositive : kFinite);
  item.number("upper", parameter.upper, {parameter.lower, kLargest, true});
  item.number("start", parameter.start, {parameter.lower, parameter.upper});
  item.finish();
  return parameter;
}

void readSearch(YamlSection& root, SearchParams& search) {
  YamlSection section = root.section("search");
  std::string method = wordOf(search.method);
  section.text("method", method);
  checked(section, [&] { search.method = searchMethod(method); });
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
  tuning.fitness = readFitness(root, true);
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
