// Offsets of disturbances that would lead one out of its range: it is clamped there, and that is
// said. The plant's node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "fmbpc/config/loop_file.hpp"

namespace fpc {

/// Offsets of the loop file and of people alike. What is scheduled is read when the first offset
/// comes into force.
class CutOffsets {
 public:
  explicit CutOffsets(const LoopFile& loop);
  /// Call it with every sample and the commands that took effect with it; at sample 0 nothing is in
  /// force any more, and the final sample is not one that an offset acts on.
  void look(const Measurement& now, const std::vector<CommandEffect>& effects);
  /// "an offset of T_in was asked beyond its range, 0..40 [degC], and clamped": one line per
  /// disturbance, empty while nothing is.
  const std::string& lines() const { return lines_; }
  std::uint64_t samples() const { return samples_; }  ///< with such words, since it was made

 private:
  void take(const Command& command);
  double scheduled(std::size_t index, std::uint32_t step);

  LoopFile loop_;
  std::vector<SignalInfo> all_;         // disturbances of the plant
  std::vector<ActiveCommand> offsets_;  // in force, by disturbance
  std::optional<Matrix> values_;        // scheduled, by step
  std::string lines_;
  std::uint64_t samples_{};
};

}  // namespace fpc
