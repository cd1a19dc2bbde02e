#include "fmbpc/control/setpoint_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

// Finite stand-in for "no clamp", so that the sum of two huge operator_state is not passed on as
// infinite.
constexpr double kHuge = std::numeric_limits<double>::max();

Vector filled(const Vector& given, Eigen::Index n_y, double absent) {
  return given.size() == 0 ? Vector(Vector::Constant(n_y, absent)) : given;
}

void validateOptional(const Vector& values, Eigen::Index n_y, const std::string& key) {
  require(values.size() == 0 || values.size() == n_y, key, std::to_string(n_y) + " numbers");
  require(!values.hasNaN(), key, "numbers, not NaN");
}

// NaN cells take the value before them, so that every entry says all outputs.
void fillSchedule(SetpointParams& params) {
  const Vector* before = &params.initial;
  for (SetpointStep& entry : params.schedule) {
    for (Eigen::Index i = 0; i < entry.value.size(); ++i)
      if (std::isnan(entry.value[i])) entry.value[i] = (*before)[i];
    before = &entry.value;
  }
}

}  // namespace

void SetpointParams::validate(Eigen::Index n_y) const {
  const std::string count = std::to_string(n_y) + " numbers";
  require(initial.size() == n_y, "setpoint.initial", count);
  require(initial.allFinite(), "setpoint.initial", "finite numbers");
  double previous = 0.0;
  for (std::size_t i = 0; i < schedule.size(); ++i) {
    const std::string key = "setpoint.schedule[" + std::to_string(i) + "].";
    require(std::isfinite(schedule[i].time_h) && schedule[i].time_h >= 0.0, key + "time_h",
            "a time >= 0 h");
    require(schedule[i].time_h >= previous, key + "time_h",
            "a time not before the previous one and the end of its ramp");
    require(schedule[i].value.size() == n_y, key + "value", count);
    require(!schedule[i].value.array().isInf().any(), key + "value", "finite numbers");
    require(std::isfinite(schedule[i].ramp_h) && schedule[i].ramp_h >= 0.0, key + "ramp_h",
            "a time >= 0 h");
    previous = schedule[i].time_h + schedule[i].ramp_h * (1.0 - 1e-12);
  }
  validateOptional(lower, n_y, "setpoint.lower");
  validateOptional(upper, n_y, "setpoint.upper");
  validateOptional(rate_per_h, n_y, "setpoint.rate_per_h");
  if (lower.size() == n_y && upper.size() == n_y)
    require((lower.array() <= upper.array()).all(), "setpoint.upper", "numbers not below lower");
  require((rate_per_h.array() > 0.0).all(), "setpoint.rate_per_h", "numbers > 0");
}

SetpointSource::SetpointSource(SetpointParams params, const std::vector<std::string>& output_names,
                               const SampleClock& clock)
    : SetpointSource(std::move(params), CommandTable(output_names), clock) {}

SetpointSource::SetpointSource(SetpointParams params, const PlantInfo& plant,
                               const SampleClock& clock)
    : SetpointSource(std::move(params), CommandTable(plant.outputs), clock) {}

SetpointSource::SetpointSource(SetpointParams params, CommandTable commands,
                               const SampleClock& clock)
    : params_(std::move(params)), clock_(clock), commands_(std::move(commands)) {
  const auto n_y = static_cast<Eigen::Index>(commands_.names().size());
  params_.validate(n_y);
  params_.lower = filled(params_.lower, n_y, -kHuge).cwiseMax(-kHuge);
  params_.upper = filled(params_.upper, n_y, kHuge).cwiseMin(kHuge);
  params_.rate_per_h = filled(params_.rate_per_h, n_y, std::numeric_limits<double>::infinity());
  fillSchedule(params_);
  for (const SetpointStep& entry : params_.schedule)
    schedule_steps_.push_back(clock_.firstStepAtHours(entry.time_h));
  asked_ = params_.initial.cwiseMax(params_.lower).cwiseMin(params_.upper);
  present_ = unclamped_ = asked_;
  playParams();
}

// A stamp of the params may be written by hand: what is meant to be the time of a sample may differ
// by rounding, and must not cost a sample.
std::uint32_t SetpointSource::fileStep(std::int64_t time_ns) const {
  const std::int64_t sample_ns = clock_.timeAt(1) - clock_.startNanoseconds();
  return clock_.firstStepAt(time_ns - std::min<std::int64_t>(1000, sample_ns / 2));
}

std::uint32_t SetpointSource::stampStep(std::int64_t time_ns) const {
  if (time_ns <= 0) return next_step_;
  return std::max(next_step_, clock_.firstStepAt(time_ns - clock_shift_ns_));
}

void SetpointSource::playParams() {
  for (const Command& command : params_.commands)
    commands_.accept(command, command.time_ns <= 0 ? 0 : fileStep(command.time_ns));
}

void SetpointSource::reset() { fresh_ = true; }

void SetpointSource::restart() {
  commands_.clear();
  waiting_.clear();
  restored_ = 0;
  effects_.clear();
  playParams();
  next_step_ = shift_ = 0;
  started_ = hold_asked_ = held_ = false;
  fresh_ = true;
}

void SetpointSource::carryOver() {
  commands_.carryOver(next_step_);
  shift_ -= next_step_;
  next_step_ = 0;
}

void SetpointSource::anchor(const StepHeader& sample) {
  clock_shift_ns_ = sample.time_ns - clock_.timeAt(sample.step);
}

std::uint32_t SetpointSource::command(const Command& command) {
  if (started_) {
    const std::uint32_t step = stampStep(command.time_ns);
    commands_.accept(command, step);
    return step;
  }
  CommandTable(commands_.signals()).accept(command, 0);  // throws what is to be thrown
  waiting_.push_back(command);
  return stampStep(command.time_ns);
}

bool SetpointSource::restore(const Command& command) {
  if (started_) return false;
  CommandTable(commands_.signals()).accept(command, 0);  // throws what is to be thrown
  waiting_.insert(waiting_.begin() + restored_++, command);
  return true;
}

void SetpointSource::acceptWaiting(std::uint32_t step) {
  next_step_ = step;
  started_ = true;
  for (const Command& command : waiting_)
    commands_.accept(command, command.time_ns <= 0
                                  ? step
                                  : clock_.firstStepAt(command.time_ns - clock_shift_ns_));
  waiting_.clear();
  restored_ = 0;
}

const Vector& SetpointSource::advance(std::uint32_t step) {
  if (!started_) acceptWaiting(step);
  settleHold(step);
  effects_.clear();
  for (const Command& command : commands_.advance(step))
    effects_.push_back({{clock_.timeAt(step) + clock_shift_ns_, 0, step}, command});
  scheduleAt(step, unclamped_);
  commands_.apply(unclamped_);
  asked_ = unclamped_.cwiseMax(params_.lower).cwiseMin(params_.upper);
  const std::uint32_t passed = step >= next_step_ ? step - next_step_ + 1 : 0;
  const double hours = clock_.hoursAt(passed);
  for (Eigen::Index i = 0; i < asked_.size(); ++i) {
    const double change = params_.rate_per_h[i] * hours;
    const bool free = fresh_ || std::isinf(params_.rate_per_h[i]);
    present_[i] =
        free ? asked_[i] : std::clamp(asked_[i], present_[i] - change, present_[i] + change);
  }
  next_step_ = step + 1;
  fresh_ = false;
  return present_;
}

const Vector& SetpointSource::aim(VectorRef outputs, VectorRef inputs) {
  present_ = outputs.cwiseMax(params_.lower).cwiseMin(params_.upper);
  aimed_input_ = inputs;
  return present_;
}

void SetpointSource::settleHold(std::uint32_t step) {
  if (hold_asked_ == held_) return;
  if (hold_asked_)
    held_at_ = recipeStep(step);
  else
    shift_ = step - held_at_;
  held_ = hold_asked_;
}

std::uint32_t SetpointSource::recipeStep(std::uint32_t step) const {
  if (held_) return held_at_;
  const std::int64_t at = std::int64_t{step} - static_cast<std::int32_t>(shift_);
  return static_cast<std::uint32_t>(std::max<std::int64_t>(at, 0));
}

void SetpointSource::scheduleAt(std::uint32_t step, Eigen::Ref<Vector> value) const {
  const std::uint32_t at = recipeStep(step);
  const auto after = std::upper_bound(schedule_steps_.begin(), schedule_steps_.end(), at);
  if (after == schedule_steps_.begin()) {
    value = params_.initial;
    return;
  }
  const auto index = static_cast<std::size_t>(after - schedule_steps_.begin()) - 1;
  const SetpointStep& entry = params_.schedule[index];
  value = entry.value;
  const double late_h = clock_.hoursAt(at) - entry.time_h;
  if (entry.ramp_h == 0.0 || late_h >= entry.ramp_h) return;
  const Vector& before = index == 0 ? params_.initial : params_.schedule[index - 1].value;
  value = before + std::max(late_h, 0.0) / entry.ramp_h * (entry.value - before);
}

void SetpointSource::scheduled(std::uint32_t step, Eigen::Ref<Vector> value) const {
  if (aimed_input_.size() > 0) {  // what is asked later is not what a target layer makes of it
    value = present_;
    return;
  }
  scheduleAt(step, value);
  commands_.apply(value);
  value = value.cwiseMax(params_.lower).cwiseMin(params_.upper);
}

std::vector<Command> SetpointSource::inForce() const {
  Command overrides{0, {}, {}, CommandMode::kOverride};
  Command offsets{0, {}, {}, CommandMode::kOffset};
  for (std::size_t i = 0; i < commands_.active().size(); ++i) {
    const ActiveCommand& entry = commands_.active()[i];
    if (!entry.active) continue;
    Command& list = entry.mode == CommandMode::kOverride ? overrides : offsets;
    list.name.push_back(commands_.names()[i]);
    list.value.push_back(entry.value);
  }
  std::vector<Command> commands;
  if (!overrides.name.empty()) commands.push_back(overrides);
  if (!offsets.name.empty()) commands.push_back(offsets);
  return commands;
}

std::vector<Command> SetpointSource::standing() const {
  std::vector<Command> commands = inForce();
  const std::vector<Command> later = commands_.waiting();
  commands.insert(commands.end(), later.begin(), later.end());
  commands.insert(commands.end(), waiting_.begin(), waiting_.end());
  return commands;
}

void SetpointSource::restore(const Recipe& recipe) {
  hold_asked_ = held_ = recipe.held;
  held_at_ = recipe.held_at;
  shift_ = recipe.shift;
}

}  // namespace fpc
