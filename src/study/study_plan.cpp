#include "study/study_plan.hpp"

#include <algorithm>
#include <cmath>

#include "base/text_hash.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "study/fitness.hpp"
#include "study/loop_contents.hpp"
#include "study/seeded_loop.hpp"

namespace fpc {
namespace {

using Eigen::Index;

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
  for (const auto& variation : study_.vary) prepared.numbers.push_back(unitOf(variation, read));
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
      one.drawn = drawnBy(one.seed, study_.vary);
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
