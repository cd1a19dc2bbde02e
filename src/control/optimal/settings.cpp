// The tuning of the fuzzy optimal law as texts that a person can type while the loop runs.
#include <sstream>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/optimal/law.hpp"

namespace fpc {
namespace {

using Weight = Vector QuadraticWeights::*;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// Groups behind semicolons are those of the rules; a single group is for all.
void readWeight(const std::string& text, const std::vector<SignalInfo>& signals,
                const std::string& key, Weight weight, FuzzyOptimalTuning& tuning) {
  const std::vector<std::string> groups = split(text, ';');
  if (groups.size() > 1 && tuning.rules.empty()) tuning.rules.assign(groups.size(), tuning.weight);
  require(!groups.empty() && (groups.size() == 1 || groups.size() == tuning.rules.size()), key,
          "one group of weights, or one for each rule, separated by semicolons");
  if (groups.size() == 1) readSignalValues(groups[0], signals, key, tuning.weight.*weight);
  for (std::size_t g = 0; g < tuning.rules.size(); ++g)
    readSignalValues(groups[groups.size() == 1 ? 0 : g], signals, key, tuning.rules[g].*weight);
}

std::string weightText(const FuzzyOptimalTuning& tuning, Weight weight,
                       const std::vector<SignalInfo>& signals) {
  if (tuning.rules.empty()) return signalValuesText(tuning.weight.*weight, signals);
  std::vector<std::string> groups;
  for (const QuadraticWeights& rule : tuning.rules)
    groups.push_back(signalValuesText(rule.*weight, signals));
  return join(groups, "; ");
}

}  // namespace

Settings FuzzyOptimalLaw::settings() const {
  const FuzzyOptimalTuning& t = tuning();
  return {{"horizon_steps", std::to_string(t.horizon_steps)},
          {"move_steps", std::to_string(t.move_steps)},
          {"weight_output", weightText(t, &QuadraticWeights::output, plant().outputs)},
          {"weight_move", weightText(t, &QuadraticWeights::move, plant().inputs)},
          {"weight_input", weightText(t, &QuadraticWeights::input, plant().inputs)},
          {"input_target", signalValuesText(t.input_target, plant().inputs)}};
}

bool FuzzyOptimalLaw::retune(const Settings& settings) {
  FuzzyOptimalTuning t = tuning();
  const auto &outputs = plant().outputs, &inputs = plant().inputs;
  for (const auto& [key, text] : settings) {
    const std::string where = "controller." + key;
    if (key == "horizon_steps") {
      t.horizon_steps = settingInteger(text, where);
    } else if (key == "move_steps") {
      t.move_steps = settingInteger(text, where);
    } else if (key == "weight_output") {
      readWeight(text, outputs, where, &QuadraticWeights::output, t);
    } else if (key == "weight_move") {
      readWeight(text, inputs, where, &QuadraticWeights::move, t);
    } else if (key == "weight_input") {
      readWeight(text, inputs, where, &QuadraticWeights::input, t);
    } else {
      require(key == "input_target", where, "a setting that may change in a run");
      readSignalValues(text, inputs, where, t.input_target);
    }
  }
  retune(std::move(t));
  return true;
}

}  // namespace fpc
