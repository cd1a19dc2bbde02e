// The reader of tuning files: what it reads, what it refuses, and that docs/tuning_file.md tells it
// all.
#include <cmath>
#include <map>
#include <regex>
#include <set>

#include "base/yaml_node.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/text.hpp"
#include "paths.hpp"
#include "study/fitness.hpp"
#include "study/tuning_fixture.hpp"
#include "study/tuning_objective.hpp"

namespace fpc {
namespace config_tuning_file_test {

std::string errorIn(const std::string& text) {
  return errorOf([&] { parseTuning(text, "t.yaml"); });
}

std::string with(const std::string& from, const std::string& to) {
  std::string text = lagTuning();
  return text.replace(text.find(from), from.size(), to);
}

TEST(TuningFile, IsReadIntoItsStructs) {
  const std::string scenarios =
      "scenarios: [{name: a, set: {setpoint.initial: {y: 2}, x.0.b: [1, 2]}}, {seed: 7, loop: "
      "other}]\ntitle: T";
  const TuningFile tuning = parseTuning(with("scenarios: {seeds: [1, 2]}", scenarios), "t.yaml");
  EXPECT_EQ(tuning.title, "T");
  ASSERT_EQ(tuning.parameters.size(), 2U);
  EXPECT_TRUE(tuning.parameters[0].logarithmic);
  EXPECT_TRUE(std::isnan(tuning.parameters[0].start));
  ASSERT_EQ(tuning.scenarios.size(), 2U);
  EXPECT_EQ(tuning.scenarios[0].set[0].first, "setpoint.initial");
  EXPECT_EQ(tuning.scenarios[0].set[0].second, "{y: 2}");
  EXPECT_EQ(tuning.scenarios[0].set[1].second, "[1, 2]");
  EXPECT_EQ(tuning.scenarios[1].name, "seed 7");
  EXPECT_EQ(tuning.scenarios[1].loop, "other");
  EXPECT_EQ(tuning.held_out.size(), 3U);
  EXPECT_EQ(tuning.search.population, 8);
  EXPECT_EQ(tuning.search.method, SearchMethod::kApso);
  EXPECT_EQ(tuning.fitness.terms[1].signal, "u");
}

TEST(TuningFile, AnEnsembleIsASeedForEachDrawnPlant) {
  const TuningFile tuning = parseTuning(
      with("seeds: [1, 2]", "seeds: 1:8, vary: {a.b: [0.5, 2], c: {values: [1, 3]}}"), "t.yaml");
  ASSERT_EQ(tuning.scenarios.size(), 8U);
  EXPECT_EQ(tuning.scenarios[7].name, "seed 8");
  ASSERT_EQ(tuning.scenarios[7].vary.size(), 2U);
  EXPECT_EQ(tuning.scenarios[7].vary[0].key, "a.b");
  EXPECT_TRUE(tuning.scenarios[7].vary[0].factor);
  EXPECT_FALSE(tuning.scenarios[7].vary[1].factor);
}

TEST(TuningFile, WithoutScenariosTheLoopIsTunedAsItIs) {
  const TuningFile tuning = parseTuning(with("scenarios: {seeds: [1, 2]}\n", ""), "t.yaml");
  ASSERT_EQ(tuning.scenarios.size(), 1U);
  EXPECT_TRUE(tuning.scenarios[0].set.empty());
}

TEST(TuningFile, RangesAreLinearLogarithmicOrWhole) {
  const TuningParameter linear{"k", 2.0, 6.0, false, false, 0.0};
  const TuningParameter logarithmic{"k", 0.01, 100.0, true, false, 0.0};
  const TuningParameter whole{"k", 3.0, 9.0, false, true, 0.0};
  EXPECT_EQ(linear.value(0.25), 3.0);
  EXPECT_NEAR(logarithmic.value(0.75), 10.0, 1e-12);
  EXPECT_EQ(whole.value(0.3), 5.0);
  for (const auto* p : {&linear, &logarithmic}) {
    EXPECT_NEAR(p->share(p->value(0.37)), 0.37, 1e-12);
    EXPECT_EQ(p->share(1e9), 1.0);
    EXPECT_NEAR(p->value(0.0), p->lower, 1e-12);
    EXPECT_NEAR(p->value(1.0), p->upper, 1e-12);
  }
}

TEST(TuningFile, MistakesNameFileKeyAndWhatWasExpected) {
  expectWords(errorIn(""), {"t.yaml", "parameters", "at least one"});
  expectWords(errorIn(with("lower: 0.1, upper: 5, scale: log", "lower: 0, upper: 5, scale: log")),
              {"t.yaml:2", "lower", "> 0"});
  expectWords(errorIn(with("lower: 0.1, upper: 5", "lower: 6, upper: 5")), {"upper", "> 6"});
  expectWords(errorIn(with("scale: log", "scale: cubic")), {"scale", "linear, log"});
  expectWords(errorIn(with("upper: 5", "upper: 5, start: 7")), {"start", "<= 5"});
  expectWords(errorIn(with("ki_per_h", "kp")), {"key", "only once"});
  expectWords(errorIn(with("index: ise", "index: isse")), {"index", "ise", "step_cost"});
  expectWords(errorIn(with("output: y", "input: y")), {"input", "unknown key"});
  expectWords(errorIn(with("weight: 0.1", "weight: -1")), {"weight", ">= 0"});
  std::string weightless = with("weight: 0.1", "weight: 0");
  weightless.replace(weightless.find("output: y"), 9, "output: y, weight: 0");
  expectWords(errorIn(weightless), {"fitness.terms", "a weight > 0"});
  expectWords(errorIn(with("    - {index: ise, output: y}\n    - {index: effort, input: u, weight: "
                           "0.1}\n",
                           "    []\n")),
              {"fitness.terms", "at least one"});
  expectWords(errorIn(with("fitness:\n", "fitness:\n  across: best\n")), {"across", "median"});
  expectWords(errorIn(with("fitness:\n", "fitness:\n  failure: 0\n")), {"failure", "> 0"});
  expectWords(errorIn(with("seeds: [1, 2]", "seeds: [1, 1]")), {"scenarios.seeds", "only once"});
  expectWords(errorIn(with("seeds: [1, 2]", "seeds: [1.5]")), {"scenarios.seeds", "whole"});
  expectWords(errorIn(with("seeds: [1, 2]", "seeds: [1, 2], vary: {a.b: [2, 1]}")),
              {"scenarios.vary", "lower < upper of a.b"});
  expectWords(errorIn(with("{seeds: [1, 2]}", "[{vary: {a.b: [1, 2]}}]")), {"vary", "a seed"});
  expectWords(errorIn(with("{seeds: [1, 2]}", "[{set: 3}]")), {"set", "mapping"});
  expectWords(errorIn(with("population: 8", "population: 0")), {"search.population", ">= 1"});
  expectWords(errorIn(with("population: 8", "method: simplex")), {"search.method", "apso"});
  expectWords(errorIn(lagTuning("speed: 3\n")), {"speed", "unknown key"});
  expectWords(errorOf([] { readTuning("nothing"); }), {"tuning 'nothing'", "column"});
}

/// Rows "| `key` | default | meaning |" of the page.
std::map<std::string, std::string> documented() {
  std::ifstream stream(sourceDir() + "/docs/tuning_file.md");
  std::map<std::string, std::string> rows;
  const std::regex row(R"(\| `([a-z_\[\].]+)` \| ([^|]*) \| ([^|]+) \|)");
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_match(line, match, row)) rows[match[1]] = match[2];
  }
  return rows;
}

/// The keys that the reader names when it meets one that it does not know.
std::set<std::string> known(const std::string& prefix, const std::string& error) {
  std::set<std::string> keys;
  const std::regex word(R"([A-Za-z_]+)");
  const std::string list = error.substr(error.find("one of ") + 7);
  for (std::sregex_iterator w(list.begin(), list.end(), word), end; w != end; ++w)
    keys.insert(prefix + (*w).str());
  return keys;
}

TEST(TuningDocs, TellEveryKeyOfTheReaderAndNoOther) {
  std::set<std::string> all;
  const auto add = [&](const std::string& prefix, const std::string& from, const std::string& to) {
    const std::string error = errorIn(with(from, to));
    ASSERT_NE(error.find("unknown key"), std::string::npos) << error;
    for (const auto& key : known(prefix, error)) all.insert(key);
  };
  add("", "search:", "nonsense: 1\nsearch:");
  add("parameters[].", "{key:", "{nonsense: 1, key:");
  add("fitness.", "fitness:\n", "fitness:\n  nonsense: 1\n");
  add("fitness.terms[].", "{index: ise,", "{nonsense: 1, index: ise,");
  add("fitness.terms[].", "{index: effort,", "{nonsense: 1, index: effort,");
  add("fitness.terms[].", "{index: ise, output: y}", "{nonsense: 1, index: consumption}");
  add("scenarios.", "{seeds: [1, 2]}", "{nonsense: 1}");
  add("scenarios[].", "{seeds: [1, 2]}", "[{nonsense: 1}]");
  add("search.", "search: {", "search: {nonsense: 1, ");
  for (const char* section : {"parameters", "fitness", "fitness.terms", "scenarios", "search"})
    all.erase(section);
  const auto rows = documented();
  for (const auto& key : all)
    EXPECT_EQ(rows.count(key), 1U) << key << " is not in docs/tuning_file.md";
  for (const auto& row : rows) EXPECT_EQ(all.count(row.first), 1U) << row.first << " is no key";
}

TEST(TuningDocs, TellTheDefaultsOfTheStructs) {
  const SearchParams s;
  const FitnessParams f;
  const std::map<std::string, std::string> defaults{
      {"fitness.band", exactText(f.band)},
      {"fitness.time_unit", f.time_unit},
      {"fitness.across", wordOf(f.across)},
      {"fitness.relative", "false"},
      {"fitness.failure", ".inf"},
      {"fitness.terms[].weight", exactText(FitnessTerm{}.weight)},
      {"parameters[].scale", "linear"},
      {"parameters[].integer", "false"},
      {"search.method", wordOf(s.method)},
      {"search.population", std::to_string(s.population)},
      {"search.evaluations", std::to_string(s.evaluations)},
      {"search.seed", std::to_string(s.seed)},
      {"search.cognitive", exactText(s.cognitive)},
      {"search.social", exactText(s.social)},
      {"search.speed_upper", exactText(s.speed_upper)},
      {"search.inertia", exactText(s.inertia)},
      {"search.inertia_start", exactText(s.inertia_start)},
      {"search.inertia_end", exactText(s.inertia_end)},
      {"search.differential_weight", exactText(s.differential_weight)},
      {"search.crossover", exactText(s.crossover)},
      {"search.variant", std::to_string(s.variant)},
      {"search.step", exactText(s.step)}};
  const auto rows = documented();
  for (const auto& [key, value] : defaults) {
    ASSERT_EQ(rows.count(key), 1U) << key;
    EXPECT_EQ(rows.at(key), value) << key;
  }
}

TEST(TuningDocs, TellEveryIndex) {
  std::ifstream stream(sourceDir() + "/docs/tuning_file.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), {});
  for (const auto& index : fitnessIndices())
    EXPECT_NE(page.find("`" + index + "`"), std::string::npos) << index;
}

TEST(TuningFile, EveryShippedOneCanBeRead) {
  EXPECT_GE(tuningNames().size(), 3U);
  for (const auto& name : tuningNames()) {
    try {
      readTuning(name);
    } catch (const InputError& error) {  // cmaes is asked for, and this build has no pagmo2
      EXPECT_NE(std::string(error.what()).find("need pagmo2"), std::string::npos) << error.what();
    }
  }
}

}  // namespace config_tuning_file_test
}  // namespace fpc
