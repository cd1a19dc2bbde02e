// What may change of a type of controller in a run, in one table: every key is tied to its field
// once, and what tools offer, what they show and what they take all follow from it.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/settings.hpp"

namespace fpc {

/// Whose values a text of several numbers holds.
struct SettingSignals {
  const std::vector<SignalInfo>& outputs;
  const std::vector<SignalInfo>& inputs;
};

/// The rows of a table of a struct of parameters:
///   SettingsTable<PiParams> table;
///   table.number("gain", &PiParams::gain, "input unit per output unit", 0.0, 10.0)
///       .ofInputs("weight_move", &PiParams::weight_move, "of squared moves");
template <typename Params>
class SettingsTable {
 public:
  using Show = std::function<std::string(const Params&, const SettingSignals&)>;
  /// @throws InputError naming `where`.
  using Take = std::function<void(const std::string& text, const std::string& where,
                                  const SettingSignals&, Params&)>;

  SettingsTable& add(SettingInfo info, Show show, Take take) {
    infos_.push_back(std::move(info));
    ways_.push_back({std::move(show), std::move(take)});
    return *this;
  }

  SettingsTable& number(const std::string& key, double Params::*field, const std::string& words,
                        double lower, double upper) {
    return add(
        {key, SettingKind::kNumber, words, lower, upper},
        [field](const Params& p, const SettingSignals&) { return exactText(p.*field); },
        [field](const std::string& text, const std::string& where, const SettingSignals&,
                Params& p) { p.*field = settingNumber(text, where); });
  }

  SettingsTable& integer(const std::string& key, int Params::*field, const std::string& words,
                         int lower, int upper) {
    return add(
        {key, SettingKind::kInteger, words, static_cast<double>(lower), static_cast<double>(upper)},
        [field](const Params& p, const SettingSignals&) { return std::to_string(p.*field); },
        [field](const std::string& text, const std::string& where, const SettingSignals&,
                Params& p) { p.*field = settingInteger(text, where); });
  }

  SettingsTable& ofOutputs(const std::string& key, Vector Params::*field,
                           const std::string& words) {
    return ofSignals(key, field, words, [](const SettingSignals& s) { return &s.outputs; });
  }
  SettingsTable& ofInputs(const std::string& key, Vector Params::*field, const std::string& words) {
    return ofSignals(key, field, words, [](const SettingSignals& s) { return &s.inputs; });
  }

  const std::vector<SettingInfo>& infos() const { return infos_; }

  Settings show(const Params& params, const SettingSignals& signals) const {
    Settings shown;
    for (std::size_t i = 0; i < infos_.size(); ++i)
      shown.emplace_back(infos_[i].key, ways_[i].show(params, signals));
    return shown;
  }

  /// Puts the texts into their fields. @throws InputError naming controller.KEY; `params` may then
  /// be half changed.
  void take(const Settings& settings, const SettingSignals& signals, Params& params) const {
    for (const auto& [key, text] : settings) {
      std::size_t row = 0;
      while (row < infos_.size() && infos_[row].key != key) ++row;
      const std::string where = "controller." + key;
      require(row < infos_.size(), where, "a setting that may change in a run");
      ways_[row].take(text, where, signals, params);
    }
  }

 private:
  struct Way {
    Show show;
    Take take;
  };
  template <typename Which>
  SettingsTable& ofSignals(const std::string& key, Vector Params::*field, const std::string& words,
                           Which which) {
    return add(
        {key, SettingKind::kText, words},
        [=](const Params& p, const SettingSignals& signals) {
          return signalValuesText(sized(p.*field, *which(signals)), *which(signals));
        },
        [=](const std::string& text, const std::string& where, const SettingSignals& signals,
            Params& p) {
          Vector values = sized(p.*field, *which(signals));
          readSignalValues(text, *which(signals), where, values);
          p.*field = values;
        });
  }
  /// Zeros in the place of values that nobody gave.
  static Vector sized(const Vector& values, const std::vector<SignalInfo>& signals) {
    const auto n = static_cast<Eigen::Index>(signals.size());
    return values.size() == n ? values : Vector(Vector::Zero(n));
  }

  std::vector<SettingInfo> infos_;
  std::vector<Way> ways_;
};

}  // namespace fpc
