// PI control, one loop per input: the rival that must be beaten honestly.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/control/controller.hpp"

namespace fpc {

/// u = bias + kp e + ki int e dt, e = sign (setpoint - y). Gains in input units per output unit (and per hour).
struct PiLoop {
  int input{};   ///< index of the input it moves
  int output{};  ///< index of the output it follows
  double kp{};
  double ki_per_h{};
  double bias{};
  bool reverse{false};        ///< e = y - setpoint
  std::string anti_windup{"clamp"};  ///< none, clamp (conditional integration), tracking (back-calculation)
  std::string start{"bias"};  ///< bias: integral starts at 0; bumpless: integral makes u(0) = input_applied
};

struct PiParams {
  std::vector<PiLoop> loops;
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
};

/// Inputs without a loop stay where they are. The integral uses forward Euler: I is updated after u(k) is computed.
/// A reset in the middle of a run (manual and back, gap, new model) is always bumpless.
class PiController final : public Controller {
 public:
  PiController(PiParams params, InputLimits limits, PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output) override;

 private:
  PiParams params_;
  InputLimits limits_;
  double sample_time_h_;
  std::vector<double> integral_;
  std::vector<bool> bumpless_pending_;
};

}  // namespace fpc
