#include "tool/stability_subject.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

#include "config/extending_loop.hpp"
#include "config/loop_file.hpp"
#include "config/model_file.hpp"
#include "control/fmbpc/law.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/yaml_section.hpp"
#include "fmbpc/model/model_match.hpp"
#include "model/undelayed.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

std::map<std::string, double> parsePoint(const std::string& at) {
  std::map<std::string, double> values;
  std::stringstream parts(at);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto equal = part.find('=');
    require(equal != std::string::npos, "--at", "NAME=VALUE,..., not \"" + part + "\"");
    const auto value = numberOf(part.substr(equal + 1));
    require(value.has_value(), "--at", "a finite number after " + part.substr(0, equal + 1));
    require(values.emplace(part.substr(0, equal), *value).second, "--at " + part.substr(0, equal),
            "every name only once");
  }
  return values;
}

bool isLoop(const std::string& name) {
  const auto names = loopNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  const std::string file = findModel(name);
  if (!std::filesystem::is_regular_file(file)) return true;  // readLoop() says what is missing
  const YamlSection top = YamlSection::load(file);
  return top.has("plant") || top.has("extends");
}

double nominalOf(const StabilitySubject& subject, SignalKind kind, int index) {
  const std::string& name = subject.model.signals(kind)[static_cast<std::size_t>(index)].name;
  if (subject.plant)
    for (const auto* list :
         {&subject.plant->description().states, &subject.plant->description().inputs,
          &subject.plant->description().disturbances})
      for (const auto& quantity : *list)
        if (quantity.name == name) return quantity.nominal;
  return usualValue(subject.model, kind, index);
}

Vector pointOf(const StabilitySubject& subject, SignalKind kind,
               std::map<std::string, double>& given, bool& chosen) {
  const auto& signals = subject.model.signals(kind);
  Vector values(static_cast<Eigen::Index>(signals.size()));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    double value = nominalOf(subject, kind, static_cast<int>(i));
    const auto found = given.find(signals[i].name);
    if (found != given.end()) {
      value = found->second;
      given.erase(found);
      chosen = true;
    }
    values[static_cast<Eigen::Index>(i)] = value;
  }
  return values;
}

void settleOn(StabilitySubject& subject) {
  subject.equilibria = fuzzyEquilibria(subject.model, subject.input, subject.disturbances);
  double nearest = std::numeric_limits<double>::infinity();
  const Vector asked = subject.outputs;
  for (const auto& rest : subject.equilibria) {
    const double distance = (rest.outputs - asked).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    subject.outputs = rest.outputs;
  }
}

/// False for a law that is not linear around its model.
bool takeLaw(StabilitySubject& subject, const LoopFile& loop, const FmbpcParams& law) {
  if (law.law == FmbpcForm::kIterated || !loop.has_model) return false;
  subject.model = withoutDelay(asIdentified(loop.model), law.delay_steps);
  subject.law.coincidence_steps = law.coincidence_steps;
  subject.law.published = law.law == FmbpcForm::kPublished;
  subject.law.weight_output = law.weight_output;
  subject.law.weight_move = law.weight_move;
  if (law.realisation == FmbpcRealisation::kLiteral)
    subject.note =
        "controller.realisation is literal; the tables of its model are of the input-output states "
        "(past outputs and inputs), not of the printed state space, which adds one sample of delay";
  return true;
}

/// Whether the loop file says a limit of the first input: by name, for all inputs, or in a list.
bool saysLimit(const LoopFile& loop, const std::string& key) {
  const std::string path = "actuator." + key;
  for (const std::string& place :
       {"." + loop.plant_info.inputs[0].name, std::string(), std::string(".0")})
    if (!scalarOf(loop.resolved, path + place).empty()) return true;
  return false;
}

/// The loop, on its model where nothing else can be simulated.
LoopFile readSimulated(const std::string& name, const Overrides& set, bool on_model) {
  Overrides rehearsal = set;
  rehearsal.emplace(rehearsal.begin(), "plant.type", "model");
  LoopFile loop = readLoop(name, on_model ? rehearsal : set);
  if (!loop.external_plant) return loop;
  require(loop.has_model, loop.name + ": model.file",
          "a model: the plant is external, and without one there is nothing to look at");
  return readLoop(name, rehearsal);
}

void readLoopInto(StabilitySubject& subject, const std::string& name, const Overrides& set,
                  bool on_model) {
  subject.loop = std::make_shared<LoopFile>(readSimulated(name, set, on_model));
  const LoopFile& loop = *subject.loop;
  subject.name = loop.name;
  subject.sample_time_s = loop.plant_info.sample_time_s;
  const FmbpcParams* law = findParams<FmbpcParams>(*loop.controller);
  subject.has_model = law && takeLaw(subject, loop, *law);
  subject.plant = makePlant(loop.simulation);
  subject.input_lower = loop.simulation.actuator.limits.lower[0];
  subject.input_upper = loop.simulation.actuator.limits.upper[0];
  subject.lower_said = saysLimit(loop, "input_lower");
  subject.upper_said = saysLimit(loop, "input_upper");
}

}  // namespace

StabilitySubject readSubject(const std::string& name, const std::vector<std::string>& set,
                             const std::string& at, bool on_model) {
  StabilitySubject subject;
  if (isLoop(name)) {
    readLoopInto(subject, name, parseOverrides(set), on_model);
  } else {
    require(set.empty(), "--set", "a loop: a model has no keys to set");
    subject.model = readModel(findModel(name));
    subject.name = subject.model.name;
    subject.has_model = true;
    subject.sample_time_s = subject.model.sample_time_s;
  }
  auto given = parsePoint(at);
  if (subject.has_model) {
    bool chosen = false, outputs = false;
    subject.input = pointOf(subject, SignalKind::kInput, given, chosen);
    subject.disturbances = pointOf(subject, SignalKind::kDisturbance, given, chosen);
    subject.outputs = pointOf(subject, SignalKind::kOutput, given, outputs);
    settleOn(subject);
  }
  require(given.empty(), "--at " + (given.empty() ? "" : given.begin()->first),
          subject.has_model
              ? "a signal of the model"
              : "a loop or model with a law that is analysed, which " + subject.name + " is not");
  return subject;
}

}  // namespace fpc::tool
