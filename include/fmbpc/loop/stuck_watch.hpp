// An input that does not follow its command.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/ring.hpp"
#include "fmbpc/control/plausibility_params.hpp"

namespace fpc {

/// An input is stuck when for `samples` samples in a row it is further from its command than
/// `tolerance` of its range and not where the actuator's limits would have brought it.
class StuckWatch {
 public:
  StuckWatch(const StuckParams& params, const InputLimits& limits,
             const std::vector<SignalInfo>& inputs);
  void reset();
  /// u(k) as it was commanded, and where the inputs were before and after it.
  void look(VectorRef commanded, VectorRef before, VectorRef applied);
  /// "input q_r does not follow its command", empty if all do.
  const std::string& words() const { return words_; }

 private:
  StuckParams params_;
  InputLimits limits_;
  std::vector<std::string> names_;
  std::vector<int> away_;  // samples in a row
  Vector expected_;
  std::string words_;
};

}  // namespace fpc
