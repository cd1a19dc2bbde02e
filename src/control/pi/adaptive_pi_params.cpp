// What the adaptive loops need to be right before they start.
#include <cmath>

#include "control/pi/adaptive_pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

void validateLoop(const AdaptiveLoop& loop, const std::string& key) {
  require(loop.input >= 0 && loop.input < 2, key + "input", "one of the plant's inputs");
  require(loop.output >= 0 && loop.output < 2, key + "output", "one of the plant's outputs");
  require(std::isfinite(loop.kp), key + "kp", "a finite number");
  require(std::isfinite(loop.ki_per_h) && loop.kp * loop.ki_per_h > 0.0, key + "ki_per_h",
          "a number with the sign of kp");
}

}  // namespace

void AdaptationParams::validate() const {
  estimator.validate();
  require(start_steps >= 0, "start_steps", "an integer >= 0");
  require(change_upper > 0.0 && change_upper <= 1.0, "change_upper", "a number in (0, 1]");
  require(std::isfinite(ratio_upper) && ratio_upper > 1.0, "ratio_upper", "a number > 1");
  require(deviation_upper > 0.0, "deviation_upper", "a number > 0");
  require(refused_steps >= 1, "refused_steps", "an integer >= 1");
}

void AdaptivePiParams::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  require(n_y == 2 && n_u == 2, "controller.type adaptive_pi", "a plant of two inputs and outputs");
  for (std::size_t i = 0; i < 2; ++i)
    validateLoop(loops[i], "controller.loops[" + std::to_string(i) + "].");
  require(loops[0].input != loops[1].input, "controller.loops", "two different inputs");
  require(loops[0].output != loops[1].output, "controller.loops", "two different outputs");
  if (decoupling || adaptation.enabled)
    for (const auto& row : model)
      for (const Fopdt& element : row) element.validate("controller.model: ");
  adaptation.validate();
}

}  // namespace fpc
