#include "control/excitation/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/random.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr std::uint64_t kExcitation = 0x65786369;  // apart from the streams of disturbances
constexpr std::int64_t kForEver = std::numeric_limits<std::int64_t>::max();

// x^10 + x^7 + 1 is primitive over {0, 1}: the register falls through all words but zero.
constexpr std::uint32_t kTaps = 1U | (1U << 3U);

bool oddNumberOfOnes(std::uint32_t word) {
  bool odd = false;
  for (; word != 0; word &= word - 1) odd = !odd;
  return odd;
}

std::string numbersWithin(double lower, double upper) {
  return "within the input's limits " + std::to_string(lower) + ".." + std::to_string(upper);
}

void validateLevels(const ExcitationSignal& s, const std::string& key, const InputLimits& limits) {
  const double lower = limits.lower[s.input], upper = limits.upper[s.input];
  const auto inside = [&](double value) { return value >= lower && value <= upper; };
  const std::string expected = "a number " + numbersWithin(lower, upper);
  for (const double level : s.levels) require(inside(level), key + "levels", expected);
  if (s.signal == ExcitationKind::kMultiLevel && !s.levels.empty()) return;
  if (s.signal == ExcitationKind::kPrbs || s.signal == ExcitationKind::kMultiLevel) {
    require(inside(s.lower) && inside(s.upper) && s.lower < s.upper, key + "range",
            "[lower, upper] " + numbersWithin(lower, upper) + ", lower < upper");
  }
  for (const ExcitationStep& entry : s.schedule)
    require(inside(entry.value), key + "schedule", "values " + numbersWithin(lower, upper));
}

void validateSignal(const ExcitationSignal& s, const std::string& key, const InputLimits& limits) {
  require(s.input >= 0 && s.input < limits.lower.size(), key + "input",
          "one of the plant's inputs");
  require(s.clock_steps >= 1, key + "clock_steps", "a number of samples >= 1");
  require(s.hold_lower_steps >= 1, key + "hold_lower_steps", "a number of samples >= 1");
  require(s.hold_upper_steps >= s.hold_lower_steps, key + "hold_s",
          "[shortest, longest] time of a level");
  require(s.signal != ExcitationKind::kSteps || !s.schedule.empty(), key + "schedule",
          "at least one entry");
  std::int64_t before = -1;
  for (const ExcitationStep& entry : s.schedule) {
    require(entry.step > before, key + "schedule", "times >= 0 that increase");
    before = entry.step;
  }
  validateLevels(s, key, limits);
}

}  // namespace

void ExcitationParams::validate(const InputLimits& limits, Eigen::Index n_y) const {
  require(!signals.empty(), "controller.signals", "at least one signal");
  std::set<int> moved;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const std::string key = "controller.signals[" + std::to_string(i) + "].";
    validateSignal(signals[i], key, limits);
    require(moved.insert(signals[i].input).second, key + "input",
            "an input that no other signal moves");
  }
  for (std::size_t i = 0; i < feedback.size(); ++i) {
    const std::string key = "controller.feedback[" + std::to_string(i) + "].";
    require(feedback[i].input >= 0 && feedback[i].input < limits.lower.size(), key + "input",
            "one of the plant's inputs");
    require(feedback[i].output >= 0 && feedback[i].output < n_y, key + "output",
            "one of the plant's outputs");
    require(std::isfinite(feedback[i].gain), key + "gain", "a finite number");
  }
}

// Never all zeros, from which it would not come back.
ShiftRegister::ShiftRegister(std::uint64_t state)
    : state_(static_cast<std::uint32_t>((state + kPeriod - 1U) % kPeriod) + 1U) {}

bool ShiftRegister::next() {
  const bool out = (state_ & 1U) != 0;
  const std::uint32_t in = oddNumberOfOnes(state_ & kTaps) ? 1U : 0U;
  state_ = (state_ >> 1U) | (in << (kBits - 1U));
  return out;
}

ExcitationStream::ExcitationStream(ExcitationSignal signal, std::uint64_t seed, double start_input)
    : signal_(std::move(signal)),
      start_input_(start_input),
      first_engine_(seededEngine(seed, {static_cast<std::uint64_t>(signal_.input), kExcitation})),
      engine_(first_engine_),
      first_register_(engine_() >> 32U),
      register_(first_register_) {
  rewind();
}

void ExcitationStream::rewind() {
  engine_ = first_engine_;
  register_ = first_register_;
  entry_ = 0;
  begin_ = 0;
  end_ = 0;
  value_ = start_input_;
  if (signal_.signal == ExcitationKind::kNone) end_ = kForEver;
}

double ExcitationStream::at(std::uint32_t step) {
  if (step < begin_) rewind();
  while (step >= end_) next();
  return value_;
}

void ExcitationStream::next() {
  begin_ = end_;
  if (signal_.signal == ExcitationKind::kPrbs) {
    value_ = register_.next() ? signal_.upper : signal_.lower;
    end_ = begin_ + signal_.clock_steps;
  } else if (signal_.signal == ExcitationKind::kMultiLevel) {
    nextLevel();
  } else {
    if (entry_ > 0) value_ = signal_.schedule[entry_ - 1].value;
    end_ = entry_ < signal_.schedule.size() ? signal_.schedule[entry_].step : kForEver;
    ++entry_;
  }
}

void ExcitationStream::nextLevel() {
  const double share = uniform(engine_);
  const auto count = static_cast<double>(signal_.levels.size());
  value_ = signal_.levels.empty() ? signal_.lower + (signal_.upper - signal_.lower) * share
                                  : signal_.levels[static_cast<std::size_t>(count * share)];
  const double choices = 1.0 + signal_.hold_upper_steps - signal_.hold_lower_steps;
  end_ = begin_ + signal_.hold_lower_steps + static_cast<std::int64_t>(choices * uniform(engine_));
}

ExcitationController::ExcitationController(ExcitationParams params, InputLimits limits,
                                           Vector start_input, const PlantInfo& plant)
    : limits_(std::move(limits)),
      feedback_(params.feedback),
      signal_(std::move(start_input)),
      unclipped_(signal_),
      no_reference_(Vector::Constant(static_cast<Eigen::Index>(plant.outputs.size()),
                                     std::numeric_limits<double>::quiet_NaN())) {
  const auto n_u = static_cast<Eigen::Index>(plant.inputs.size());
  limits_.validate(n_u);
  require(signal_.size() == n_u && signal_.allFinite(), "actuator.initial",
          std::to_string(n_u) + " finite numbers");
  params.validate(limits_, no_reference_.size());
  for (ExcitationSignal& signal : params.signals) {
    const double start = signal_[signal.input];
    streams_.emplace_back(std::move(signal), params.seed, start);
  }
}

void ExcitationController::reset(const Measurement& /*start*/) {}

void ExcitationController::step(const Measurement& now, const SetpointSource& setpoint,
                                ControllerOutput& output) {
  for (ExcitationStream& stream : streams_) signal_[stream.input()] = stream.at(now.header.step);
  unclipped_ = signal_;
  for (const ExcitationFeedback& f : feedback_)
    unclipped_[f.input] += f.gain * (setpoint.present()[f.output] - now.outputs[f.output]);
  output.begin();
  output.input = unclipped_;
  limits_.clip(output.input, now.input_applied);
  output.source = output.input == unclipped_ ? ActionSource::kBase : ActionSource::kClipped;
  output.reference = feedback_.empty() ? no_reference_ : setpoint.present();
}

}  // namespace fpc
