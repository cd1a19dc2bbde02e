#include "supervision/signal_validator.hpp"

#include <algorithm>
#include <cmath>

#include "base/no_value.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr double kRelativeRounding = 1e-9;
constexpr std::size_t kActions = 4;

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

EventCode codeOf(Doubt doubt) {
  switch (doubt) {
    case Doubt::kNoNumber:
    case Doubt::kStale:
    case Doubt::kMissing:
      return EventCode::kSignalMissing;
    case Doubt::kRange:
      return EventCode::kSignalOutOfRange;
    case Doubt::kRate:
      return EventCode::kSignalTooFast;
    case Doubt::kJump:
      return EventCode::kSignalJumped;
    case Doubt::kFrozen:
      return EventCode::kSignalFrozen;
    case Doubt::kRepeated:
      return EventCode::kSignalNotRenewed;
    case Doubt::kNone:
      break;
  }
  return EventCode::kNone;
}

Doubt doubtOf(NoValue why) {
  if (why == NoValue::kStale) return Doubt::kStale;
  return why == NoValue::kMissing ? Doubt::kMissing : Doubt::kNoNumber;
}

constexpr const char* kActionWords[kActions] = {"its last good value is used",
                                                "the model's value is used", "input held",
                                                "the configured fallback"};

}  // namespace

void PlausibilityParams::validate(std::size_t n_y, std::size_t n_d, Eigen::Index n_u) const {
  require(hold_samples >= -1, "actuator.hold_samples", "an integer >= -1");
  require(bridge_samples >= 0, "plausibility.bridge_samples", "an integer >= 0");
  require(fallback.size() == 0 || (fallback.size() == n_u && fallback.allFinite()),
          "plausibility: fallback", "a finite number per input");
  require(reaction_samples == 0 || reaction_samples >= 8, "plausibility.reaction_samples",
          "0 or an integer >= 8");
  require(outputs.size() <= n_y && disturbances.size() <= n_d, "plausibility.signals",
          "signals of the plant");
  require(needs.empty() || needs.size() == n_y + n_d, "plausibility: needs", "one per signal");
  for (const auto* group : {&outputs, &disturbances})
    for (const SignalPlausibility& signal : *group) check(signal);
}

SignalValidator::SignalValidator(PlausibilityParams params, const PlantInfo& plant)
    : params_(std::move(params)),
      n_y_(plant.outputs.size()),
      sample_time_h_(plant.sample_time_s / 3600.0),
      asked_(joined(params_, plant)),
      signals_(asked_.size()),
      needed_(asked_.size(), true) {
  params_.validate(n_y_, plant.disturbances.size(), static_cast<Eigen::Index>(plant.inputs.size()));
  expected_ = Vector::Zero(static_cast<Eigen::Index>(n_y_));
  writeTexts(plant);
}

void SignalValidator::writeTexts(const PlantInfo& plant) {
  texts_.resize(signals_.size());
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    names_.push_back(i < n_y_ ? plant.outputs[i].name : plant.disturbances[i - n_y_].name);
    for (std::size_t doubt = 0; doubt < kDoubts; ++doubt)
      for (const char* action : kActionWords)
        texts_[i].push_back(names_[i] + " " + reasonOf(static_cast<Doubt>(doubt), asked_[i]) +
                            ": " + action);
  }
}

void SignalValidator::reset() {
  for (Memory& signal : signals_) {
    signal.has_good = false;
    signal.at_level = 0;
    signal.since_good = 0;
    signal.flat.reset();
  }
  doubted_ = 0;
}

bool SignalValidator::jumped(Memory& signal, const SignalPlausibility& asked, double value) const {
  if (!signal.has_good || !(std::abs(value - signal.good) > asked.jump)) {
    signal.at_level = 0;
    return false;
  }
  const bool stays = signal.at_level > 0 && std::abs(value - signal.level) <= asked.jump;
  signal.at_level = stays ? signal.at_level + 1 : 1;
  signal.level = value;
  return signal.at_level < asked.jump_samples;
}

/// At a limit of its instrument, or at one of its own (a flow over a weir, a pump that rests), a
/// signal may stand for long.
bool SignalValidator::isFrozen(std::size_t i, double value) const {
  const SignalPlausibility& asked = asked_[i];
  const FlatLine& flat = signals_[i].flat;
  return asked.frozen && flat.isUnlikely() && value > asked.scale_lower &&
         value < asked.scale_upper && (i < n_y_ || !flat.isAtExtreme());
}

Doubt SignalValidator::judge(std::size_t i, double value) {
  Memory& signal = signals_[i];
  const SignalPlausibility& asked = asked_[i];
  if (!std::isfinite(value)) return doubtOf(whyNoValue(value));
  if (!params_.enabled) return Doubt::kNone;
  signal.flat.add(value);
  const bool jump = jumped(signal, asked, value);
  if (value < asked.lower || value > asked.upper) return Doubt::kRange;
  const double hours = static_cast<double>(signal.since_good + 1) * sample_time_h_;
  if (signal.has_good &&
      std::abs(value - signal.good) > asked.rate_per_h * hours * (1.0 + kRelativeRounding))
    return Doubt::kRate;
  if (jump) return Doubt::kJump;
  if (isFrozen(i, value)) return Doubt::kFrozen;
  const bool bridged = signal.since_good < static_cast<std::uint64_t>(params_.bridge_samples);
  return asked.repeated && bridged && signal.flat.isRepeated() ? Doubt::kRepeated : Doubt::kNone;
}

bool SignalValidator::byDefault(std::size_t i) const {
  return signals_[i].doubt == Doubt::kFrozen && asked_[i].substitute == Substitute::kHold;
}

/// A gap that is short is bridged, whatever is asked for a long one. What is frozen is replaced: an
/// output by the model's value, and a disturbance stays what it was.
Substitute SignalValidator::substituteOf(std::size_t signal) const {
  if (byDefault(signal)) return signal < n_y_ ? Substitute::kModel : Substitute::kLastGood;
  const auto bridged = static_cast<std::uint64_t>(params_.bridge_samples);
  return signals_[signal].since_good <= bridged ? Substitute::kModel : asked_[signal].substitute;
}

bool SignalValidator::expectsFrom(const Foresee& foresee) {
  if (!asked_law_) has_expected_ = foresee && foresee(expected_);
  asked_law_ = true;
  return has_expected_;
}

/// False if there is nothing to put in its place.
bool SignalValidator::replace(std::size_t signal, const Foresee& foresee) {
  Memory& memory = signals_[signal];
  const auto row = static_cast<Eigen::Index>(signal);
  memory.foreseen = signal < n_y_ && substituteOf(signal) == Substitute::kModel &&
                    expectsFrom(foresee) && std::isfinite(expected_[row]);
  const double value = memory.foreseen ? expected_[row] : memory.has_good ? memory.good : 0.0;
  const auto first = static_cast<Eigen::Index>(n_y_);
  (signal < n_y_ ? accepted_.outputs[row] : accepted_.disturbances[row - first]) = value;
  const bool stands = signal < n_y_ && byDefault(signal);  // so does its last value
  return memory.foreseen || (memory.has_good && !stands);
}

Verdict SignalValidator::look(const Measurement& now, const Foresee& foresee) {
  bool any = false, doubted = false, repaired = true, may_end = false;
  accepted_ = now;
  asked_law_ = false;
  const auto first = static_cast<Eigen::Index>(n_y_);
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    Memory& signal = signals_[i];
    const auto row = static_cast<Eigen::Index>(i);
    const double value = i < n_y_ ? now.outputs[row] : now.disturbances[row - first];
    signal.doubt = judge(i, value);
    if (signal.doubt == Doubt::kNone) {
      signal.good = value;
      signal.has_good = true;
      signal.since_good = 0;
      continue;
    }
    ++signal.since_good;
    any = true;
    const bool replaced = replace(i, foresee);
    if (!needed_[i] || (i >= n_y_ && byDefault(i))) continue;
    doubted = true;
    may_end = may_end || signal.doubt != Doubt::kRange || params_.range_falls;
    repaired = repaired && replaced && substituteOf(i) != Substitute::kHold;
  }
  doubted_ = doubted ? std::min(doubted_ + 1, std::numeric_limits<int>::max() - 1) : 0;
  Verdict verdict = any ? Verdict::kRepaired : Verdict::kClean;
  may_end = may_end && params_.hold_samples >= 0 && params_.fallback.size() > 0;
  if (doubted && !repaired) verdict = Verdict::kHold;
  if (may_end && doubted_ > params_.hold_samples) verdict = Verdict::kFallback;
  say(verdict);
  return verdict;
}

void SignalValidator::say(Verdict verdict) {
  notice_ = {};
  const bool needed_only = verdict == Verdict::kHold || verdict == Verdict::kFallback;
  for (std::size_t i = 0; i < signals_.size(); ++i) {
    if (signals_[i].doubt == Doubt::kNone || (needed_only && !needed_[i])) continue;
    const std::size_t action = verdict == Verdict::kFallback ? 3
                               : verdict == Verdict::kHold   ? 2
                               : signals_[i].foreseen        ? 1
                                                             : 0;
    const auto doubt = static_cast<std::size_t>(signals_[i].doubt);
    notice_ = {codeOf(signals_[i].doubt), texts_[i][doubt * kActions + action].c_str(),
               names_[i].c_str()};
    return;
  }
}

}  // namespace fpc
