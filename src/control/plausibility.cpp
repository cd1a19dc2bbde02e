#include "fmbpc/control/plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/no_value.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kRounding = 1e-9;
constexpr std::size_t kVerdicts = 4;

std::vector<SignalPlausibility> joined(const PlausibilityParams& params, const PlantInfo& plant) {
  std::vector<SignalPlausibility> all = params.outputs;
  all.resize(plant.outputs.size());
  all.insert(all.end(), params.disturbances.begin(), params.disturbances.end());
  all.resize(plant.outputs.size() + plant.disturbances.size());
  return all;
}

void check(const SignalPlausibility& signal) {
  require(signal.lower <= signal.upper, "plausibility.signals: upper", "a number >= lower");
  require(signal.rate_per_h > 0.0, "plausibility.signals: rate_per_h", "a number > 0");
  require(signal.jump > 0.0, "plausibility.signals: jump", "a number > 0");
  require(signal.jump_samples >= 1, "plausibility.signals: jump_samples", "an integer >= 1");
  require(signal.frozen_samples >= -1, "plausibility.signals: frozen_samples", "an integer >= -1");
}

std::string reasonOf(Doubt doubt, const SignalPlausibility& asked) {
  switch (doubt) {
    case Doubt::kNoNumber:
      return "is no number";
    case Doubt::kStale:
      return "is stale";
    case Doubt::kMissing:
      return "has not come";
    case Doubt::kRange:
      return "is outside [" + shortText(asked.lower) + ", " + shortText(asked.upper) + "]";
    case Doubt::kRate:
      return "changes faster than " + shortText(asked.rate_per_h) + " per hour";
    case Doubt::kJump:
      return "jumped by more than " + shortText(asked.jump);
    case Doubt::kFrozen:
      return "is frozen";
    case Doubt::kRepeated:
      return "was not read anew";
    case Doubt::kNone:
      break;
  }
  return "";
}

Doubt doubtOf(NoValue why) {
  if (why == NoValue::kStale) return Doubt::kStale;
  return why == NoValue::kMissing ? Doubt::kMissing : Doubt::kNoNumber;
}

std::string actionOf(Verdict verdict, Substitute substitute) {
  if (verdict == Verdict::kHold) return "input held";
  if (verdict == Verdict::kFallback) return "the configured fallback";
  return substitute == Substitute::kModel ? "the model's value is used"
                                          : "its last good value is used";
}

}  // namespace

void PlausibilityParams::validate(std::size_t n_y, std::size_t n_d, Eigen::Index n_u) const {
  require(hold_samples >= -1, "plausibility.hold_samples", "an integer >= -1");
  require(frozen_input >= 0.0 && std::isfinite(frozen_input), "plausibility.frozen_input",
          "a number >= 0");
  require(fallback.size() == 0 || (fallback.size() == n_u && fallback.allFinite()),
          "plausibility: fallback", "a finite number per input");
  require(reaction_samples == 0 || reaction_samples >= 8, "plausibility.reaction_samples",
          "0 or an integer >= 8");
  require(reaction != DoubtAction::kFallback || fallback.size() > 0, "plausibility.reaction",
          "an actuator.fallback to go to");
  require(plant_bounds != DoubtAction::kFallback || fallback.size() > 0,
          "plausibility.plant_bounds", "an actuator.fallback to go to");
  require(outputs.size() <= n_y && disturbances.size() <= n_d, "plausibility.signals",
          "signals of the plant");
  require(needs.empty() || needs.size() == n_y + n_d, "plausibility: needs", "one per signal");
  for (const auto* group : {&outputs, &disturbances})
    for (const SignalPlausibility& signal : *group) check(signal);
}

Plausibility::Plausibility(PlausibilityParams params, const PlantInfo& plant)
    : params_(std::move(params)),
      n_y_(plant.outputs.size()),
      sample_time_h_(plant.sample_time_s / 3600.0),
      input_range_(static_cast<Eigen::Index>(plant.inputs.size())),
      output_range_(static_cast<Eigen::Index>(n_y_)),
      asked_(joined(params_, plant)),
      signals_(asked_.size()),
      needed_(asked_.size(), true) {
  params_.validate(n_y_, plant.disturbances.size(), input_range_.size());
  for (Eigen::Index i = 0; i < input_range_.size(); ++i) {
    const SignalInfo& input = plant.inputs[static_cast<std::size_t>(i)];
    input_range_[i] = input.upper - input.lower;
  }
  for (Memory& signal : signals_)
    signal.input_low = signal.input_high = Vector::Zero(input_range_.size());
  for (std::size_t i = 0; i < n_y_; ++i) {
    output_range_[static_cast<Eigen::Index>(i)] = plant.outputs[i].upper - plant.outputs[i].lower;
    uses_model_ = uses_model_ || asked_[i].substitute == Substitute::kModel ||
                  (params_.enabled && asked_[i].frozen_samples < 0);
  }
  writeWords(plant);
}

void Plausibility::writeWords(const PlantInfo& plant) {
  texts_.resize(signals_.size());
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    const std::string& name = i < n_y_ ? plant.outputs[i].name : plant.disturbances[i - n_y_].name;
    for (std::size_t doubt = 0; doubt < kDoubts; ++doubt)
      for (std::size_t verdict = 0; verdict < kVerdicts; ++verdict)
        texts_[i].push_back(
            name + " " + reasonOf(static_cast<Doubt>(doubt), asked_[i]) + ": " +
            actionOf(static_cast<Verdict>(verdict), substituteOf(i, static_cast<Doubt>(doubt))));
  }
}

void Plausibility::reset() {
  for (Memory& signal : signals_) {
    signal.has_good = false;
    signal.at_level = signal.against = 0;
    signal.since_good = 0;
    signal.flat.reset();
  }
  has_forecast_ = has_expected_ = false;
  doubted_ = 0;
}

bool Plausibility::jumped(Memory& signal, const SignalPlausibility& asked, double value) const {
  if (!signal.has_good || !(std::abs(value - signal.good) > asked.jump)) {
    signal.at_level = 0;
    return false;
  }
  const bool stays = signal.at_level > 0 && std::abs(value - signal.level) <= asked.jump;
  signal.at_level = stays ? signal.at_level + 1 : 1;
  signal.level = value;
  return signal.at_level < asked.jump_samples;
}

Doubt Plausibility::judge(std::size_t i, double value, const Measurement& now) {
  Memory& signal = signals_[i];
  const SignalPlausibility& asked = asked_[i];
  if (!std::isfinite(value)) return doubtOf(whyNoValue(value));
  if (!params_.enabled) return Doubt::kNone;
  const bool frozen = isFrozen(i, value, now);
  const bool jump = jumped(signal, asked, value);
  if (value < asked.lower || value > asked.upper) return Doubt::kRange;
  const double hours = static_cast<double>(signal.since_good + 1) * sample_time_h_;
  if (signal.has_good &&
      std::abs(value - signal.good) > asked.rate_per_h * hours * (1.0 + kRounding))
    return Doubt::kRate;
  if (jump) return Doubt::kJump;
  if (frozen) return Doubt::kFrozen;
  return isRepeated(i) ? Doubt::kRepeated : Doubt::kNone;
}

/// Where nothing else is asked for, what is frozen is replaced: an output by the model's value, and
/// a disturbance stays what it was.
Substitute Plausibility::substituteOf(std::size_t signal, Doubt doubt) const {
  const SignalPlausibility& asked = asked_[signal];
  const bool stands = doubt == Doubt::kFrozen || doubt == Doubt::kRepeated;
  if (!stands || asked.frozen_samples >= 0 || asked.substitute != Substitute::kHold)
    return asked.substitute;
  return signal < n_y_ ? Substitute::kModel : Substitute::kLastGood;
}

/// False if there is nothing to put in its place.
bool Plausibility::replace(std::size_t signal) {
  Memory& memory = signals_[signal];
  const auto row = static_cast<Eigen::Index>(signal);
  const bool model = substituteOf(signal, memory.doubt) == Substitute::kModel && has_expected_ &&
                     signal < n_y_ && std::isfinite(expected_[row]);
  const double value = model ? expected_[row] : memory.has_good ? memory.good : 0.0;
  const auto first = static_cast<Eigen::Index>(n_y_);
  (signal < n_y_ ? accepted_.outputs[row] : accepted_.disturbances[row - first]) = value;
  const bool stands = memory.doubt == Doubt::kFrozen && signal < n_y_;  // so does its last value
  return model || (memory.has_good && !(stands && asked_[signal].frozen_samples < 0));
}

Verdict Plausibility::look(const Measurement& now) {
  bool any = false, doubted = false, repaired = true, may_end = false;
  accepted_ = now;
  forecast(now.input_applied);
  const auto first = static_cast<Eigen::Index>(n_y_);
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    Memory& signal = signals_[i];
    const auto row = static_cast<Eigen::Index>(i);
    const double value = i < n_y_ ? now.outputs[row] : now.disturbances[row - first];
    signal.doubt = judge(i, value, now);
    if (signal.doubt == Doubt::kNone) {
      signal.good = value;
      signal.has_good = true;
      signal.since_good = 0;
      continue;
    }
    ++signal.since_good;
    any = true;
    const bool replaced = replace(i);
    const Substitute substitute = substituteOf(i, signal.doubt);
    const bool goes_on = i >= n_y_ && substitute != asked_[i].substitute;  // a frozen disturbance
    if (!needed_[i] || goes_on) continue;
    doubted = true;
    may_end = may_end || signal.doubt != Doubt::kRange || params_.range_falls;
    repaired = repaired && replaced && substitute != Substitute::kHold;
  }
  doubted_ = doubted ? std::min(doubted_ + 1, std::numeric_limits<int>::max() - 1) : 0;
  Verdict verdict = any ? Verdict::kRepaired : Verdict::kClean;
  may_end = may_end && params_.hold_samples >= 0 && params_.fallback.size() > 0;
  if (doubted && !repaired) verdict = Verdict::kHold;
  if (may_end && doubted_ > params_.hold_samples) verdict = Verdict::kFallback;
  say(verdict);
  return verdict;
}

void Plausibility::say(Verdict verdict) {
  words_ = "";
  const bool needed_only = verdict == Verdict::kHold || verdict == Verdict::kFallback;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (signals_[i].doubt == Doubt::kNone || (needed_only && !needed_[i])) continue;
    const std::size_t text = static_cast<std::size_t>(signals_[i].doubt) * kVerdicts;
    words_ = texts_[i][text + static_cast<std::size_t>(verdict)].c_str();
    return;
  }
}

// y(k+1) = C (A x(k) + B u(k) + g) + h
void Plausibility::expect(const PredictiveAction& prediction) {
  state_ = prediction.offset_state;
  state_.noalias() += prediction.A * prediction.state;
  rest_ = prediction.offset_output;
  rest_.noalias() += prediction.C * state_;
  effect_.noalias() = prediction.C * prediction.B;
  has_forecast_ = true;
}

/// Of this sample, with the input that was applied.
void Plausibility::forecast(VectorRef input) {
  has_expected_ = has_forecast_ && input.allFinite();
  has_forecast_ = false;
  if (!has_expected_) return;
  expected_ = rest_;
  expected_.noalias() += effect_ * input;
}

}  // namespace fpc
