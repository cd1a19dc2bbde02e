// Inputs that people put (disturbance input/NAME) where the actuator cannot go: it is clamped to
// its limits, and that is said. The plant's node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"

namespace fpc {

/// An override counts that is beyond the input's limits, an offset that is wider than they are
/// apart: an input that an offset leads beyond them from where it is told to be is no slip.
class ForcedInputs {
 public:
  /// The inputs' ranges are the actuator's limits.
  explicit ForcedInputs(const PlantInfo& info);
  /// Call it with every sample and the commands that took effect with it; at sample 0 nothing is in
  /// force any more.
  void look(std::uint32_t step, const std::vector<CommandEffect>& effects);
  /// "input/u was asked to be 1e+300, beyond its limits, 0..1600 [m3/d], and clamped": one line per
  /// input, empty while nothing is.
  const std::string& lines() const { return words_; }
  std::uint64_t samples() const { return samples_; }  ///< with such words, since it was made

 private:
  void take(const Command& command);
  std::string judge(const SignalInfo& input, CommandMode mode, double value) const;

  std::vector<SignalInfo> inputs_;
  std::vector<std::string> lines_;  // by input
  std::string words_;
  std::uint64_t samples_{};
};

}  // namespace fpc
