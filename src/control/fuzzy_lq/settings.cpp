// The tuning of the fuzzy optimal law as texts that a person can type while the loop runs.
#include <utility>

#include "base/split.hpp"
#include "control/fuzzy_lq/law.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

using Weight = Vector QuadraticWeights::*;

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

SettingsTable<FuzzyOptimalParams>& addWeight(SettingsTable<FuzzyOptimalParams>& table,
                                             const std::string& key, Weight weight, bool of_inputs,
                                             const std::string& words) {
  const auto signalsOf = [of_inputs](const SettingSignals& s) -> const auto& {
    return of_inputs ? s.inputs : s.outputs;
  };
  return table.add(
      {key, SettingKind::kText, words},
      [=](const FuzzyOptimalParams& p, const SettingSignals& signals) {
        return weightText(p.tuning, weight, signalsOf(signals));
      },
      [=](const std::string& text, const std::string& where, const SettingSignals& signals,
          FuzzyOptimalParams& p) {
        readWeight(text, signalsOf(signals), where, weight, p.tuning);
      });
}

SettingsTable<FuzzyOptimalParams>& addSteps(SettingsTable<FuzzyOptimalParams>& table,
                                            const std::string& key, int FuzzyOptimalTuning::*steps,
                                            const std::string& words) {
  return table.add(
      {key, SettingKind::kInteger, words, 1, 1000},
      [=](const FuzzyOptimalParams& p, const SettingSignals&) {
        return std::to_string(p.tuning.*steps);
      },
      [=](const std::string& text, const std::string& where, const SettingSignals&,
          FuzzyOptimalParams& p) { p.tuning.*steps = settingInteger(text, where); });
}

SettingsTable<FuzzyOptimalParams> makeTable() {
  using Tuning = FuzzyOptimalTuning;
  SettingsTable<FuzzyOptimalParams> t;
  addSteps(t, "horizon_steps", &Tuning::horizon_steps, "prediction horizon P [samples]");
  addSteps(t, "move_steps", &Tuning::move_steps, "free moves M [samples], at most P");
  addWeight(t, "weight_output", &QuadraticWeights::output, false,
            "of squared errors: 'Ca=1 T=2', or '1 2', or one number; rules by ';'");
  addWeight(t, "weight_move", &QuadraticWeights::move, true,
            "of squared moves: 'q=0.1 qc=2', or '0.1 2', or one number; rules by ';'");
  addWeight(t, "weight_input", &QuadraticWeights::input, true,
            "of squared distances to input_target; leaves an offset");
  t.add(
      {"input_target", SettingKind::kText, "'q=100 qc=103', or '100 103', or one number"},
      [](const FuzzyOptimalParams& p, const SettingSignals& s) {
        return signalValuesText(p.tuning.input_target, s.inputs);
      },
      [](const std::string& text, const std::string& where, const SettingSignals& s,
         FuzzyOptimalParams& p) {
        readSignalValues(text, s.inputs, where, p.tuning.input_target);
      });
  return t.ofOutputs(
      "reference_pole", &FuzzyOptimalParams::reference_pole,
      "how slowly references go to the setpoint, [0, 1): 'Ca=0.9 T=0.8', or one number");
}

}  // namespace

const SettingsTable<FuzzyOptimalParams>& fuzzyOptimalSettings() {
  static const SettingsTable<FuzzyOptimalParams> table = makeTable();
  return table;
}

Settings FuzzyOptimalLaw::settings() const {
  return fuzzyOptimalSettings().show(params_, {plant().outputs, plant().inputs});
}

bool FuzzyOptimalLaw::retune(const Settings& settings) {
  FuzzyOptimalParams next = params_;
  fuzzyOptimalSettings().take(settings, {plant().outputs, plant().inputs}, next);
  retuneTo(std::move(next));
  return true;
}

}  // namespace fpc
