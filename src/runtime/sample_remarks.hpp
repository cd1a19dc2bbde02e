// What did not go as asked at a sample, in words: what the law says, and setpoints that were asked
// beyond their limits. The controller's node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/session.hpp"

namespace fpc {

/// Of setpoints what schedule and commands ask is looked at, before the rate limit; outputs
/// of report.without_setpoint are left out.
class SampleRemarks {
 public:
  explicit SampleRemarks(const LoopFile& loop);

  /// Call it with every sample that the controller has answered. One remark a line, the law's
  /// first; none of the final sample, which has no action.
  const std::string& look(const ControllerSession& controller);
  const std::string& lines() const { return lines_; }
  std::string sentence() const;  ///< the same in one line
  /// Setpoints clamped at this sample that were not, or not all, at the one before.
  bool newlyClamped() const { return newly_clamped_; }
  std::uint64_t clampedSamples() const { return clamped_samples_; }  ///< since it was made

 private:
  void lookAtSetpoints(const SetpointSource& setpoint, std::uint32_t step);
  void addLine(const char* words);

  SetpointParams limits_;
  SetpointSource schedule_;           // without commands and limits
  std::vector<std::string> words_;    // by output
  std::vector<bool> clamped_, were_;  // by output: at this sample, at the one before
  Vector asked_;                      // n_y
  std::string lines_;
  bool newly_clamped_{false};
  std::uint64_t clamped_samples_{};
};

}  // namespace fpc
