// Checks of the parameters of the fuzzy optimal law.
#include "control/fuzzy_lq/law.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"

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
  require(!observe || disturbance == FuzzyOptimalDisturbance::kInside, "controller.observer",
          "disturbance inside; got '" + wordOf(disturbance) + "'");
  if (observe) observer.validate(n_y);
  PredictiveLawParams::validate(n_y);
}

}  // namespace fpc
