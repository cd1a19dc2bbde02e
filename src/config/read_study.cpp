// Reader of study files.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "base/split.hpp"
#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "config/read_scenarios.hpp"
#include "config/study_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr std::size_t kMostSeeds = 100000;

std::uint64_t wholeNumber(const std::string& text, const std::string& where) {
  const bool digits = !text.empty() && text.size() < 19 &&
                      text.find_first_not_of("0123456789") == std::string::npos;
  require(digits, where, "whole numbers >= 0 as in 1:40 or 1,2,7; got '" + text + "'");
  return std::stoull(text);
}

double plainNumber(const std::string& text, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  require(!text.empty() && *end == '\0' && std::isfinite(value), where,
          "a number; got '" + text + "'");
  return value;
}

/// `loops`: names, or mappings {name, loop, set}.
std::vector<StudyLoop> readLoops(YamlSection& root) {
  std::vector<StudyLoop> loops;
  const YAML::Node node = root.raw("loops");
  const bool plain = node.IsDefined() && node.IsSequence() && node.size() > 0 && node[0].IsScalar();
  if (plain) {
    std::vector<std::string> names;
    root.names("loops", names);
    for (const auto& name : names) loops.push_back({name, name, {}});
    return loops;
  }
  for (auto& item : root.list("loops")) {
    StudyLoop loop;
    need(item, "loop", "name of a loop");
    item.text("loop", loop.loop);
    loop.name = loop.loop;
    item.text("name", loop.name);
    loop.set = readSet(item);
    item.finish();
    loops.push_back(std::move(loop));
  }
  return loops;
}

/// `vary`: {KEY: [lower, upper]} are factors, {KEY: {values: [lower, upper]}} numbers.
std::vector<StudyVariation> readVariations(YamlSection& root) {
  std::vector<StudyVariation> all;
  const YAML::Node node = root.raw("vary");
  if (node.IsDefined() && !node.IsMap()) root.fail("vary", "a mapping of key.path: [lower, upper]");
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    StudyVariation variation;
    variation.key = key;
    YAML::Node range = entry.second;
    if (range.IsMap()) {
      variation.factor = false;
      range = range["values"];
    }
    if (!range.IsDefined() || !range.IsSequence() || range.size() != 2)
      root.fail("vary", key + ": [lower, upper] as factors, or {values: [lower, upper]}");
    variation.lower = plainNumber(range[0].as<std::string>(), root.where("vary"));
    variation.upper = plainNumber(range[1].as<std::string>(), root.where("vary"));
    all.push_back(variation);
  }
  return all;
}

/// `noise`: {NAME: std}, or {percent_of_span: p}.
void readStudyNoise(YamlSection& root, StudyFile& study) {
  const YAML::Node node = root.raw("noise");
  if (node.IsDefined() && !node.IsMap()) root.fail("noise", "a mapping of output: std");
  for (const auto& entry : node) {
    const double value = plainNumber(entry.second.as<std::string>(), root.where("noise"));
    if (entry.first.Scalar() == "percent_of_span")
      study.noise_percent = value;
    else
      study.noise.emplace_back(entry.first.Scalar(), value);
  }
}

std::vector<std::uint64_t> readSeeds(YamlSection& root) {
  const YAML::Node node = root.raw("seeds");
  if (!node.IsDefined()) return {};
  std::string text;
  if (node.IsScalar()) text = node.Scalar();
  for (std::size_t i = 0; node.IsSequence() && i < node.size(); ++i)
    text += (i ? "," : "") + node[i].as<std::string>();
  return parseSeeds(text, root.where("seeds"));
}

}  // namespace

std::vector<std::uint64_t> parseSeeds(const std::string& text, const std::string& where) {
  std::vector<std::uint64_t> seeds;
  for (const auto& part : split(text, ',')) {
    const auto ends = split(part, ':');
    require(ends.size() == 1 || ends.size() == 2, where, "seeds as in 1:40 or 1,2,7");
    const std::uint64_t first = wholeNumber(ends.front(), where);
    const std::uint64_t last = wholeNumber(ends.back(), where);
    require(first <= last && last - first < kMostSeeds, where,
            "FIRST:LAST that do not decrease, at most " + std::to_string(kMostSeeds));
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  const std::set<std::uint64_t> once(seeds.begin(), seeds.end());
  require(!seeds.empty() && once.size() == seeds.size(), where,
          "at least one seed, each only once");
  return seeds;
}

StudyVariation parseVariation(const std::string& text) {
  const auto at = text.find('=');
  const std::string expected =
      "KEY=LOWER:UPPER (factors) or KEY=value:LOWER:UPPER; got '" + text + "'";
  require(at != std::string::npos && at > 0, "--vary", expected);
  auto parts = split(text.substr(at + 1), ':');
  StudyVariation variation;
  variation.key = text.substr(0, at);
  variation.factor = parts.empty() || parts.front() != "value";
  if (!variation.factor) parts.erase(parts.begin());
  require(parts.size() == 2, "--vary", expected);
  variation.lower = plainNumber(parts[0], "--vary " + variation.key);
  variation.upper = plainNumber(parts[1], "--vary " + variation.key);
  return variation;
}

void StudyFile::validate() const {
  require(!loops.empty(), "loops", "at least one loop");
  std::set<std::string> names;
  for (const auto& loop : loops)
    require(names.insert(loop.name).second, "loops", "names of their own; twice " + loop.name);
  require(names.count(against) > 0, "against",
          "the name of one of the loops; got '" + against + "'");
  require(!fitness.terms.empty(), "fitness.terms", "at least one {index, ...}");
  std::set<std::string> keys;
  for (const auto& v : vary) {
    require(keys.insert(v.key).second, "vary." + v.key, "every key only once");
    require(v.lower < v.upper, "vary." + v.key,
            "lower < upper (a number that does not vary stands under set), got " +
                exactText(v.lower) + " and " + exactText(v.upper));
  }
  for (const auto& scenario : scenarios)
    require(!scenario.has_seed, "scenarios", "scenarios without seeds: those stand under seeds");
  require(vary.empty() || !seeds.empty(), "vary", "seeds: they draw the numbers");
  for (const auto& [output, std] : noise) require(std >= 0.0, "noise." + output, "a number >= 0");
  require(noise_percent >= 0.0 && noise_percent <= 100.0, "noise.percent_of_span",
          "a number from 0 to 100");
  require(noise_percent == 0.0 || noise.empty(), "noise", "either percent_of_span or outputs");
}

StudyFile parseStudy(const std::string& text, const std::string& file) {
  YamlSection root = YamlSection::parse(text, file);
  StudyFile study;
  study.file = file;
  study.text = text;
  root.text("title", study.title);
  study.loops = readLoops(root);
  if (!study.loops.empty()) study.against = study.loops.back().name;
  root.text("against", study.against);
  study.set = readSet(root);
  study.seeds = readSeeds(root);
  study.vary = readVariations(root);
  readStudyNoise(root, study);
  study.scenarios = readScenarios(root, "scenarios");
  study.fitness = readFitness(root, false);
  root.boolean("noise_free", study.noise_free);
  root.integer("locked_samples", study.locked_samples, 0);
  root.integer("confidence_percent", study.confidence_percent, 50, 99);
  checked(root, [&] { study.validate(); });
  root.finish();
  return study;
}

StudyFile readStudy(const std::string& name_or_path) {
  const std::string file = findStudy(name_or_path);
  std::ifstream stream(file);
  require(stream.good(), file, "a readable file");
  std::stringstream text;
  text << stream.rdbuf();
  return parseStudy(text.str(), file);
}

}  // namespace fpc
