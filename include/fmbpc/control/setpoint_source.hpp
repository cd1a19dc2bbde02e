// Setpoints by step: schedule, a person's commands, clamp and rate limit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// From `time_h` on, `value[i]` is the setpoint of output i; NaN leaves that output as it was. With
/// `ramp_h` it is reached in a straight line at time_h + ramp_h.
struct SetpointStep {
  double time_h{};
  Vector value;
  double ramp_h{};
};

struct SetpointParams {
  Vector initial;                      ///< n_y
  std::vector<SetpointStep> schedule;  ///< times not decreasing, ramps end before the next entry
  Vector lower, upper;                 ///< n_y, clamp (infinite if absent)
  Vector rate_per_h;                   ///< n_y, largest change per hour (infinite if absent)
  std::vector<Command> commands;       ///< played like a person's, with time_ns = absolute stamps
  /// @throws InputError naming the field.
  void validate(Eigen::Index n_y) const;
};

/// A step of the schedule acts from the first sample that is not before its time (to a microsecond,
/// as do the commands of the params).
/// No allocation in advance() but when a command takes effect.
class SetpointSource {
 public:
  /// @throws InputError naming the field, also of a command in the params.
  SetpointSource(SetpointParams params, const std::vector<std::string>& output_names,
                 const SampleClock& clock);
  /// The same; what a person asks beyond the range of an output is refused.
  SetpointSource(SetpointParams params, const PlantInfo& plant, const SampleClock& clock);

  /// Forgets memory of the rate limiter; commands in force stay.
  void reset();
  /// Stops the schedule's time from the next sample on (a recipe waits for its operator), or lets
  /// it go on from where it stopped. Commands act meanwhile.
  void hold(bool on) { hold_asked_ = on; }
  bool held() const { return hold_asked_; }
  /// Releases all commands and any hold, and replays the commands of the params (a new run).
  void restart();
  /// The samples count from 0 again, but the plant is the one that was there before: what is in
  /// force stays, and so do the schedule's place and the rate limiter's memory.
  void carryOver();
  /// Tells the time that the plant gives to a sample, in case its t0 is not the clock's: the stamps
  /// of people's commands are then the plant's. The schedule goes by step.
  void anchor(const StepHeader& sample);
  /// The setpoint at `step`: schedule, commands, clamp, rate limit. Call once per sample, steps
  /// increasing; over skipped steps everything catches up. The first value is not rate-limited.
  const Vector& advance(std::uint32_t step);
  const Vector& present() const { return present_; }
  /// A target layer has decided what becomes of what is asked: these (n_y; inputs n_u), inside the
  /// params' limits, are followed at the present step, and looked ahead to. Returns them.
  const Vector& aim(VectorRef outputs, VectorRef inputs);
  /// n_u, where a target layer wants the inputs to rest; empty: there is none.
  const Vector& aimedInput() const { return aimed_input_; }
  /// What is asked of output i at the present step lies beyond the params' limits.
  bool isClamped(Eigen::Index i) const {
    return unclamped_[i] < params_.lower[i] || unclamped_[i] > params_.upper[i];
  }
  /// Preview: what the schedule (and the commands now in force) will ask at `step`, clamped; no
  /// memory touched, no allocation.
  void scheduled(std::uint32_t step, Eigen::Ref<Vector> value) const;
  /// A person's command; returns the step from which it acts (stamp 0: the next sample; before the
  /// first sample this is 0, whatever step comes first).
  /// @throws InputError (nothing is taken) on an unknown name, wrong lengths, value or mode, or a
  /// value beyond the range of its output (between that and the params' limits it is clamped).
  std::uint32_t command(const Command& command);
  /// Puts a command back in force that was in force when this source was lost; what a person has
  /// commanded since is newer and wins. Only before the first sample: later the source knows
  /// better, ignores it and returns false.
  /// @throws InputError as command().
  bool restore(const Command& command);
  /// What is in force now, as commands for restore(): at most one override and one offset.
  std::vector<Command> inForce() const;
  /// The same with what waits for its time.
  std::vector<Command> standing() const;
  /// Where the schedule is, for a source that takes over in the middle of a run: held or not, at
  /// which step it is held, how many samples it is late (modulo 2^32: after carryOver() it may be
  /// early).
  struct Recipe {
    bool held{};
    std::uint32_t held_at{}, shift{};
  };
  Recipe recipe() const { return {hold_asked_, held_at_, shift_}; }
  void restore(const Recipe& recipe);
  /// Commands that took effect with the present sample; run_id is left to the caller.
  const std::vector<CommandEffect>& effects() const { return effects_; }
  const CommandTable& table() const { return commands_; }

 private:
  SetpointSource(SetpointParams params, CommandTable commands, const SampleClock& clock);
  void settleHold(std::uint32_t step);
  std::uint32_t recipeStep(std::uint32_t step) const;
  void scheduleAt(std::uint32_t step, Eigen::Ref<Vector> value) const;
  std::uint32_t fileStep(std::int64_t time_ns) const;
  std::uint32_t stampStep(std::int64_t time_ns) const;
  void acceptWaiting(std::uint32_t step);
  void playParams();

  SetpointParams params_;
  SampleClock clock_;
  CommandTable commands_;
  std::vector<std::uint32_t> schedule_steps_;
  std::vector<Command> waiting_;  // people's commands before the first sample: its step is unknown
  std::ptrdiff_t restored_{};     // of them: those at the front
  std::vector<CommandEffect> effects_;
  Vector present_, asked_, unclamped_;  // asked_: unclamped_ inside the limits
  Vector aimed_input_;                  // not empty: present_ is a target
  std::int64_t clock_shift_ns_{};
  std::uint32_t next_step_{};
  bool started_{false}, fresh_{true};
  bool hold_asked_{false}, held_{false};
  std::uint32_t held_at_{}, shift_{};  // recipe step while held; samples the recipe is late
};

}  // namespace fpc
