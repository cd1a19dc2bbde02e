#include "study/study_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/random.hpp"
#include "base/text_hash.hpp"
#include "config/extending_loop.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "study/fitness.hpp"
#include "study/loop_contents.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// The number at a key of a resolved loop, or the plant's own where the loop does not say.
double ownNumber(const LoopFile& loop, const std::string& key) {
  const std::string text = scalarOf(loop.resolved, key);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::isfinite(value)) return value;
  const std::string expected = "a key that has a number in loop " + loop.name;
  require(text.empty() && !loop.external_plant, "vary." + key, expected);
  const PlantDescription about = makePlant(loop.simulation)->description();
  using Section = std::pair<std::string, const std::vector<Quantity>&>;
  for (const auto& [section, quantities] :
       {Section{"plant.parameters", about.parameters}, Section{"plant.initial_state", about.states},
        Section{"disturbance.nominal", about.disturbances}})
    for (const Quantity& quantity : quantities)
      if (key == section + "." + quantity.name) return quantity.nominal;
  throw InputError("vary." + key + ": expected " + expected);
}

/// What factors are laid over.
double numberAt(const LoopFile& loop, const std::string& key) {
  const double number = ownNumber(loop, key);
  require(
      number != 0.0, "vary." + key,
      "values (value:LOWER:UPPER) in place of factors: the number of loop " + loop.name + " is 0");
  return number;
}

/// Distance from the least to the largest setpoint, or the setpoint where that never changes.
Vector spanOf(const LoopFile& loop) {
  Vector least = loop.setpoint.initial, most = least;
  for (const auto& step : loop.setpoint.schedule)
    for (Index i = 0; i < least.size(); ++i) {
      if (step.value.size() != least.size() || !std::isfinite(step.value[i])) continue;
      least[i] = std::min(least[i], step.value[i]);
      most[i] = std::max(most[i], step.value[i]);
    }
  Vector span = most - least;
  for (Index i = 0; i < span.size(); ++i)
    if (span[i] == 0.0) span[i] = std::abs(most[i]);
  return span;
}

Overrides noiseOf(const StudyFile& study, const LoopFile& loop) {
  Overrides noise;
  const std::vector<std::string> outputs = namesOf(loop.plant_info.outputs);
  for (const auto& [output, std] : study.noise)
    require(std::find(outputs.begin(), outputs.end(), output) != outputs.end(), "noise." + output,
            "one of " + join(outputs) + " of loop " + loop.name);
  for (const auto& [output, std] : study.noise)
    noise.emplace_back("noise.std." + output, exactText(std));
  if (study.noise_percent == 0.0) return noise;
  const Vector span = spanOf(loop);
  for (Index i = 0; i < span.size(); ++i) {
    const std::string& output = outputs[static_cast<std::size_t>(i)];
    require(span[i] > 0.0, "noise.percent_of_span",
            "a std for each output in place of it: the setpoint of " + output + " in loop " +
                loop.name + " rests at 0");
    noise.emplace_back("noise.std." + output, exactText(0.01 * study.noise_percent * span[i]));
  }
  return noise;
}

/// Whether some output has noise once the study's own is laid over the loop's.
bool hasNoise(const StudyFile& study, const LoopFile& loop) {
  if (study.noise_percent != 0.0) return true;
  Vector std = loop.simulation.noise_std;
  const std::vector<std::string> outputs = namesOf(loop.plant_info.outputs);
  for (const auto& [output, value] : study.noise)
    std[std::find(outputs.begin(), outputs.end(), output) - outputs.begin()] = value;
  return std.any();
}

}  // namespace

std::vector<std::string> seededKeys(const LoopFile& loop, bool noisy) {
  std::vector<std::string> keys;
  if (loop.disturbance.source == DisturbanceSource::kPattern)
    keys.emplace_back("disturbance.pattern.seed");
  if (noisy) keys.emplace_back("noise.seed");
  const auto& sensors = loop.simulation.instruments.sensors;
  if (std::any_of(sensors.begin(), sensors.end(), [](const auto& sensor) {
        return sensor.second.noise_std > 0.0 || sensor.second.lost > 0.0;
      }))
    keys.emplace_back("sensors.seed");
  const auto& parameters = loop.simulation.parameters;
  const auto local = parameters.find("local_noise");
  if (local != parameters.end() && local->second > 0.0)
    keys.emplace_back("plant.parameters.local_noise_seed");
  return keys;
}

StudyPlan::StudyPlan(StudyFile study) : study_(std::move(study)) {
  study_.validate();
  makeCases();
  std::string all = study_.text;
  for (const auto& loop : study_.loops) {
    prepared_.emplace_back();
    for (std::size_t s = 0; s < std::max<std::size_t>(1, study_.scenarios.size()); ++s) {
      prepared_.back().push_back(
          prepare(loop, study_.scenarios.empty() ? nullptr : &study_.scenarios[s]));
      all += prepared_.back().back().text + prepared_.back().back().contents;
    }
    all += loop.name;
  }
  for (const auto& one : cases_) all += one.name;
  for (const auto& [key, value] : study_.set) all += key + value;
  fingerprint_ = textHash(all);
  for (std::size_t i = 0; i < prepared_.size(); ++i)  // drawn numbers may fail later, in their run
    checkFitness(study_.fitness, parseLoop(prepared_[i].front().text, study_.loops[i].name));
}

StudyPlan::Prepared StudyPlan::prepare(const StudyLoop& loop,
                                       const TuningScenario* scenario) const {
  const std::string name = scenario && !scenario->loop.empty() ? scenario->loop : loop.loop;
  Overrides overrides = study_.set;
  overrides.insert(overrides.end(), loop.set.begin(), loop.set.end());
  if (scenario) overrides.insert(overrides.end(), scenario->set.begin(), scenario->set.end());
  const LoopFile read = readLoop(name, overrides);
  Prepared prepared;
  prepared.text = read.resolved;
  prepared.contents = contentsOf(read);
  prepared.noise = noiseOf(study_, read);
  for (const auto& variation : study_.vary)
    prepared.numbers.push_back(variation.factor ? numberAt(read, variation.key) : 1.0);
  prepared.seeded = seededKeys(read, hasNoise(study_, read));
  require(study_.seeds.empty() || !prepared.seeded.empty() || !study_.vary.empty(), "seeds",
          "a disturbance pattern, noise or vary in loop " + read.name);
  return prepared;
}

void StudyPlan::makeCases() {
  const std::size_t scenarios = std::max<std::size_t>(1, study_.scenarios.size());
  const std::size_t seeds = std::max<std::size_t>(1, study_.seeds.size());
  for (std::size_t s = 0; s < scenarios; ++s) {
    for (std::size_t i = 0; i < seeds; ++i) {
      StudyCase one;
      if (!study_.scenarios.empty()) one.scenario = study_.scenarios[s].name;
      one.has_seed = !study_.seeds.empty();
      if (one.has_seed) one.seed = study_.seeds[i];
      const std::string seed = one.has_seed ? "seed " + std::to_string(one.seed) : "";
      one.name = one.scenario + (one.scenario.empty() || seed.empty() ? "" : ", ") + seed;
      if (one.name.empty()) one.name = "as it is";
      for (std::size_t v = 0; v < study_.vary.size(); ++v) {
        std::mt19937_64 engine = seededEngine(one.seed, {0x5354554459U, v});
        const StudyVariation& range = study_.vary[v];
        one.drawn.push_back(range.lower + (range.upper - range.lower) * uniform(engine));
      }
      cases_.push_back(std::move(one));
    }
  }
}

LoopFile StudyPlan::loop(std::size_t run) const {
  const StudyCase& one = cases_[caseOf(run)];
  const std::size_t seeds = std::max<std::size_t>(1, study_.seeds.size());
  const Prepared& prepared = prepared_[loopOf(run)][caseOf(run) / seeds];
  Overrides overrides = prepared.noise;
  for (std::size_t v = 0; v < study_.vary.size(); ++v)
    overrides.emplace_back(study_.vary[v].key, exactText(prepared.numbers[v] * one.drawn[v]));
  for (const auto& key : prepared.seeded)
    if (one.has_seed) overrides.emplace_back(key, std::to_string(one.seed));
  return parseLoop(prepared.text, study_.loops[loopOf(run)].name, overrides);
}

}  // namespace fpc
