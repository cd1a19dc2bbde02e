// Plays an operator's commands in a run in one process, each at the first sample that is not before
// its time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/command_file.hpp"
#include "plant/simulation.hpp"
#include "runtime/identifier_session.hpp"
#include "runtime/session.hpp"
#include "runtime/target_session.hpp"

namespace fpc {

/// Whom commands may reach, and who is told what could not be done.
struct CommandTargets {
  Simulation& simulation;
  ControllerSession& controller;
  std::function<void(int window)> identify;
  std::function<void(const std::string& why)> refused;
  TargetSession* layer{nullptr};  ///< hears setpoints, too
};

class CommandPlayer {
 public:
  CommandPlayer(std::vector<TimedCommand> commands, const SampleClock& clock)
      : commands_(std::move(commands)), clock_(clock) {}

  /// Setpoints and disturbances are handed over with their times, as by stamped messages: call it
  /// before sample 0 is answered. A disturbance acts from sample 1 on at the earliest.
  void begin(const CommandTargets& targets);
  /// What is due before sample `step` is answered.
  void advance(std::uint32_t step, const CommandTargets& targets);
  /// What the run ended before, in words; empty if everything was played.
  std::string unplayed() const;

 private:
  std::uint32_t stepOf(const TimedCommand& command) const;

  std::vector<TimedCommand> commands_;
  SampleClock clock_;
  std::size_t next_{};
};

}  // namespace fpc
