// Setpoints by step: schedule, a person's commands, clamp and rate limit.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/base/ring.hpp"
#include "fmbpc/base/sample_clock.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// From `time_h` on, `value[i]` is the setpoint of output i; NaN leaves that output as it was.
struct SetpointStep {
  double time_h{};
  Vector value;
};

struct SetpointParams {
  Vector initial;                      ///< n_y
  std::vector<SetpointStep> schedule;  ///< times not decreasing
  Vector lower, upper;                 ///< n_y, clamp (infinite if absent)
  Vector rate_per_h;                   ///< n_y, largest change per hour (infinite if absent)
  std::vector<Command> commands;       ///< played like a person's, with time_ns = absolute stamps
  void validate(Eigen::Index n_y) const;
};

class SetpointSource {
 public:
  SetpointSource(SetpointParams params, std::vector<std::string> output_names, const SampleClock& clock);

  /// Forgets memory of the rate limiter; commands in force stay.
  void reset();
  /// Releases all commands and replays those of the params (a new run).
  void restart();
  /// The setpoint at `step`: schedule, commands, clamp, rate limit. Call once per sample, steps increasing.
  const Vector& advance(std::uint32_t step);
  const Vector& present() const { return present_; }
  /// Preview: what the schedule (and the commands now in force) will ask at `step`, clamped; no memory touched.
  void scheduled(std::uint32_t step, Eigen::Ref<Vector> value) const;
  /// A person's command; returns the step from which it acts (stamp 0: the next sample).
  std::uint32_t command(const Command& command);
  const std::vector<CommandEffect>& effects() const { return effects_; }
  const CommandTable& table() const { return commands_; }

 private:
  void scheduleAt(std::uint32_t step, Eigen::Ref<Vector> value) const;

  SetpointParams params_;
  SampleClock clock_;
  CommandTable commands_;
  std::vector<std::uint32_t> schedule_steps_;
  std::vector<CommandEffect> effects_;
  Vector present_;
  std::uint32_t next_step_{};
  bool fresh_{true};
};

}  // namespace fpc
