// The tuning of the fuzzy optimal law as texts that a person can type while the loop runs.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "control/optimal/memory.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Weight = Vector QuadraticWeights::*;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

double numberOf(const std::string& text, const std::string& key) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, value);
  require(!text.empty() && read.ec == std::errc() && read.ptr == end, key,
          "numbers, got '" + text + "'");
  return value;
}

int integerOf(const std::string& text, const std::string& key) {
  const double value = numberOf(text, key);
  require(std::abs(value) <= 1e9 && value == std::floor(value), key, "an integer");
  return static_cast<int>(value);
}

/// One number for all, n numbers, or NAME=number with names left out as they are.
void readValues(std::string text, const std::vector<SignalInfo>& signals, const std::string& key,
                Vector& values) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream stream(text);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  require(!words.empty(), key, "a number, one for each signal, or NAME=number");
  if (words[0].find('=') == std::string::npos) {
    require(words.size() == 1 || words.size() == signals.size(), key,
            "one number, or " + std::to_string(signals.size()));
    for (std::size_t i = 0; i < signals.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = numberOf(words[words.size() == 1 ? 0 : i], key);
    return;
  }
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    const auto place = std::find_if(signals.begin(), signals.end(), [&](const SignalInfo& s) {
      return equals != std::string::npos && s.name == word.substr(0, equals);
    });
    require(place != signals.end(), key, "NAME=number with names of the plant, got '" + word + "'");
    values[place - signals.begin()] = numberOf(word.substr(equals + 1), key);
  }
}

std::string textOf(const Vector& values, const std::vector<SignalInfo>& signals) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < signals.size(); ++i)
    words.push_back(signals[i].name + "=" + exactText(values[static_cast<Eigen::Index>(i)]));
  return join(words, " ");
}

/// Groups behind semicolons are those of the rules; a single group is for all.
void readWeight(const std::string& text, const std::vector<SignalInfo>& signals,
                const std::string& key, Weight weight, FuzzyOptimalTuning& tuning) {
  const std::vector<std::string> groups = split(text, ';');
  if (groups.size() > 1 && tuning.rules.empty()) tuning.rules.assign(groups.size(), tuning.weight);
  require(!groups.empty() && (groups.size() == 1 || groups.size() == tuning.rules.size()), key,
          "one group of weights, or one for each rule, separated by semicolons");
  if (groups.size() == 1) readValues(groups[0], signals, key, tuning.weight.*weight);
  for (std::size_t g = 0; g < tuning.rules.size(); ++g)
    readValues(groups[groups.size() == 1 ? 0 : g], signals, key, tuning.rules[g].*weight);
}

std::string weightText(const FuzzyOptimalTuning& tuning, Weight weight,
                       const std::vector<SignalInfo>& signals) {
  if (tuning.rules.empty()) return textOf(tuning.weight.*weight, signals);
  std::vector<std::string> groups;
  for (const QuadraticWeights& rule : tuning.rules) groups.push_back(textOf(rule.*weight, signals));
  return join(groups, "; ");
}

}  // namespace

Settings FuzzyOptimalLaw::settings() const {
  const FuzzyOptimalTuning& t = tuning();
  const PlantInfo& plant = memory_->plant;
  return {{"horizon_steps", std::to_string(t.horizon_steps)},
          {"move_steps", std::to_string(t.move_steps)},
          {"weight_output", weightText(t, &QuadraticWeights::output, plant.outputs)},
          {"weight_move", weightText(t, &QuadraticWeights::move, plant.inputs)},
          {"weight_input", weightText(t, &QuadraticWeights::input, plant.inputs)},
          {"input_target", textOf(t.input_target, plant.inputs)}};
}

bool FuzzyOptimalLaw::retune(const Settings& settings) {
  FuzzyOptimalTuning t = tuning();
  const auto &outputs = memory_->plant.outputs, &inputs = memory_->plant.inputs;
  for (const auto& [key, text] : settings) {
    const std::string where = "controller." + key;
    if (key == "horizon_steps") {
      t.horizon_steps = integerOf(text, where);
    } else if (key == "move_steps") {
      t.move_steps = integerOf(text, where);
    } else if (key == "weight_output") {
      readWeight(text, outputs, where, &QuadraticWeights::output, t);
    } else if (key == "weight_move") {
      readWeight(text, inputs, where, &QuadraticWeights::move, t);
    } else if (key == "weight_input") {
      readWeight(text, inputs, where, &QuadraticWeights::input, t);
    } else {
      require(key == "input_target", where, "a setting that may change in a run");
      readValues(text, inputs, where, t.input_target);
    }
  }
  retune(std::move(t));
  return true;
}

}  // namespace fpc
