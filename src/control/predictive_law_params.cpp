// What every predictive law is told, from its section of a loop file.
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/predictive_law.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {

void PredictiveLawParams::validate(Eigen::Index n_y) const {
  require(reference_pole.size() == n_y, "controller.reference_pole",
          std::to_string(n_y) + " numbers");
  for (Eigen::Index i = 0; i < n_y; ++i)
    require(reference_pole[i] >= 0.0 && reference_pole[i] < 1.0, "controller.reference_pole",
            "numbers >= 0 and < 1");
  require(reference_holdback.size() == 0 ||
              (reference_holdback.size() == n_y && reference_holdback.minCoeff() > 0.0),
          "controller.reference_holdback", std::to_string(n_y) + " numbers > 0");
  require(transfer_decay >= 0.0 && transfer_decay < 1.0, "transfer_decay", "a number >= 0 and < 1");
  require(prediction_steps >= 1 && prediction_steps <= 100000, "controller.prediction_steps",
          "an integer from 1 to 100000");
}

void readPredictiveLaw(YamlSection& section, const ControllerContext& loop,
                       PredictiveLawParams& params) {
  params.reference_pole = Vector::Constant(loop.outputCount(), 0.9);
  params.reference_holdback = Vector::Constant(loop.outputCount(), kInfinity);
  section.byName("reference_pole", params.reference_pole, loop.outputs(), {0.0, 1.0});
  section.byName("reference_holdback", params.reference_holdback, loop.outputs(),
                 {0.0, kInfinity, true});
  section.boolean("preview", params.preview);
  readPredictionSteps(section, loop, params.prediction_steps);
}

}  // namespace fpc
