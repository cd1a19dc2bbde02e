// Reader of study files.
#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "config/read_scenarios.hpp"
#include "config/study_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

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

}  // namespace

void StudyFile::validate() const {
  require(!loops.empty(), "loops", "at least one loop");
  std::set<std::string> names;
  for (const auto& loop : loops)
    require(names.insert(loop.name).second, "loops", "names of their own; twice " + loop.name);
  require(names.count(against) > 0, "against",
          "the name of one of the loops; got '" + against + "'");
  require(!fitness.terms.empty(), "fitness.terms", "at least one {index, ...}");
  checkVariations(vary);
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
