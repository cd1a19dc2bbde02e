// What did not go as an operator asked in a run, for the remarks of its record: commands refused,
// setpoints clamped. Private to the project.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/loop/record.hpp"

namespace fpc {

class OperatorNotes {
 public:
  explicit OperatorNotes(const LoopFile& loop);

  /// A command that was not done, due at `step`. The first twenty are kept in words, others
  /// counted.
  void refused(std::uint32_t step, const std::string& words);
  /// What is asked for sample `step`, beside the limits of the loop: call it when the sample is
  /// answered. Commands only; what the file's schedule asks was checked when it was read.
  void look(const SetpointSource& setpoint, std::uint32_t step);
  /// Which setpoint of the sample looked at last is clamped, in words; empty if none is.
  const std::string& clamped() const;
  std::vector<RunRemark> remarks() const;

 private:
  SetpointParams limits_;
  std::vector<SignalInfo> outputs_;
  SetpointSource schedule_;  // without commands and limits
  Vector asked_;
  std::vector<RunRemark> refused_, clamped_;  // the latter by output
  std::optional<std::size_t> clamped_now_;    // output
  std::uint64_t more_{};
};

}  // namespace fpc
