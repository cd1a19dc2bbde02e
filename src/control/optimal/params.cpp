// Checks of the parameters of the fuzzy optimal law.
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/optimal/law.hpp"

namespace fpc {
namespace {

void requireCount(const Vector& values, Eigen::Index n, const char* key) {
  require(values.size() == n && values.allFinite(), std::string(key),
          std::to_string(n) + " finite numbers");
}

}  // namespace

void FuzzyOptimalTuning::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  require(horizon_steps >= 1 && horizon_steps <= 1000, "controller.horizon_steps",
          "an integer from 1 to 1000");
  require(move_steps >= 1 && move_steps <= horizon_steps, "controller.move_steps",
          "an integer from 1 to horizon_steps");
  weight.validate(n_y, n_u, "controller");
  for (std::size_t g = 0; g < rules.size(); ++g)
    rules[g].validate(n_y, n_u, "controller.rules[" + std::to_string(g) + "]");
  requireCount(input_target, n_u, "controller.input_target");
}

void FuzzyOptimalParams::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  tuning.validate(n_y, n_u);
  require(solve == "together" || solve == "each", "controller.solve", "together or each");
  require(disturbance == "inside" || disturbance == "outside" || disturbance == "none",
          "controller.disturbance", "one of inside, outside, none, got '" + disturbance + "'");
  require(disturbance_gain > 0.0 && disturbance_gain <= 1.0, "controller.disturbance_gain",
          "a number > 0 and <= 1");
  require(!observe || disturbance == "inside", "controller.observer",
          "disturbance inside; got '" + disturbance + "'");
  if (observe) observer.validate(n_y);
  requireCount(reference_pole, n_y, "controller.reference_pole");
  require((reference_pole.array() >= 0.0).all() && (reference_pole.array() < 1.0).all(),
          "controller.reference_pole", "numbers >= 0 and < 1");
  require(disturbance_nominal.allFinite(), "controller.disturbance_nominal", "finite numbers");
  require(transfer_decay >= 0.0 && transfer_decay < 1.0, "controller.transfer_decay",
          "a number >= 0 and < 1");
  require(prediction_steps >= 1 && prediction_steps <= 100000, "controller.prediction_steps",
          "an integer from 1 to 100000");
}

}  // namespace fpc
