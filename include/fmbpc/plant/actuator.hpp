// The last guard before the plant: whatever arrives, the applied input is finite, inside its bounds and its move limit.
#pragma once

#include <string>

#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

struct ActuatorParams {
  InputLimits limits;
  Vector initial;              ///< n_u, u(-1)
  Vector fallback;             ///< n_u, applied after `hold_samples` samples without an action
  int hold_samples{-1};        ///< samples an absent action is replaced by the last input; -1: for ever
  void validate(Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// Applies, holds or falls back. Memory: the applied input and how long nothing has come.
class Actuator {
 public:
  explicit Actuator(ActuatorParams params);
  void reset();
  /// Applies a commanded input; a wrong size or a non-finite element counts as absent.
  void apply(VectorRef commanded);
  /// No action came in time.
  void miss();
  const Vector& applied() const { return applied_; }
  std::uint32_t clips() const { return clips_; }  ///< elements of the last command beyond 1e-9 of the range
  bool missing() const { return missed_ > 0; }
  const ActuatorParams& params() const { return params_; }

 private:
  ActuatorParams params_;
  Vector applied_, wanted_;
  int missed_{};
  std::uint32_t clips_{};
};

}  // namespace fpc
