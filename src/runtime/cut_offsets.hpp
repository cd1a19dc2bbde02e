// Offsets of disturbances that would lead one out of its range: it is clamped there, and that is
// said. The plant's node and the run in one process are made of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/command_table.hpp"
#include "plant/simulation.hpp"

namespace fpc {

/// Offsets of the loop file and of people alike.
class CutOffsets {
 public:
  /// `disturbances`: of the plant.
  explicit CutOffsets(std::vector<Quantity> disturbances);
  /// Call it with every sample; at sample 0 nothing is in force any more, and the final sample is
  /// not one that an offset acts on.
  void look(const Simulation& simulation) {
    look(simulation.measurement(), simulation.effects(), simulation.scheduledDisturbances());
  }
  /// `effects`: commands that took effect with the sample; `scheduled`: the disturbances without
  /// any (n_d).
  void look(const Measurement& now, const std::vector<CommandEffect>& effects, VectorRef scheduled);
  /// "an offset of T_in was asked beyond its range, 0..40 [degC], and clamped": one line per
  /// disturbance, empty while nothing is.
  const std::string& lines() const { return lines_; }
  std::uint64_t samples() const { return samples_; }  ///< with such words, since it was made

 private:
  void take(const Command& command);

  std::vector<Quantity> all_;           // disturbances of the plant
  std::vector<ActiveCommand> offsets_;  // in force, by disturbance
  std::string lines_;
  std::uint64_t samples_{};
};

}  // namespace fpc
