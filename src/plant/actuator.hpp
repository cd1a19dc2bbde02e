// The last guard before the plant: whatever arrives, the applied input is finite, inside its bounds
// and its move limit.
#pragma once

#include <cstdint>
#include <string>

#include "fmbpc/base/input_limits.hpp"
#include "fmbpc/base/types.hpp"
#include "plant/instruments.hpp"

namespace fpc {

struct ActuatorParams {
  InputLimits limits;
  Vector initial;                   ///< n_u, u(-1)
  Vector fallback;                  ///< n_u, applied after `hold_samples` samples without an action
  std::vector<DriveParams> drives;  ///< how late each input follows; empty: at once
  int hold_samples{10};  ///< samples an absent action is replaced by the last input; -1: for ever
  void validate(Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// Applies, holds or falls back. Memory: the applied input and how long nothing has come. Moves are
/// limited from where the actuator really is, so it also comes back from a fault no faster than its
/// move limit.
class Actuator {
 public:
  explicit Actuator(ActuatorParams params);
  void reset();
  /// Applies a commanded input; a wrong size or a non-finite element counts as absent.
  void apply(VectorRef commanded);
  /// No action came in time.
  void miss();
  /// A fault puts element i elsewhere (stuck valve, offset): clamped to the bounds, free of the
  /// move limit. What a later miss() holds is the last input without faults.
  void disturb(Eigen::Index i, double position);
  const Vector& applied() const { return applied_; }  ///< the true position
  std::uint32_t clips() const {
    return clips_;
  }  ///< elements of the last command beyond 1e-9 of the range
  bool missing() const { return missed_ > 0; }
  /// Nothing has come for longer than an input is held.
  bool fellBack() const { return params_.hold_samples >= 0 && missed_ > params_.hold_samples; }
  const ActuatorParams& params() const { return params_; }

 private:
  void moveTo(VectorRef target);

  ActuatorParams params_;
  Vector applied_, commanded_, previous_;
  int missed_{};
  std::uint32_t clips_{};
};

}  // namespace fpc
