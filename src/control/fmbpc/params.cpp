// Checks of the parameters of the fuzzy model-based predictive law.
#include <algorithm>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/fmbpc/law.hpp"

namespace fpc {
namespace {

void requireWeights(const Vector& weight, Eigen::Index n, const std::string& key) {
  require(weight.size() == n, key, std::to_string(n) + " numbers");
  require(weight.allFinite() && (weight.array() >= 0.0).all(), key, "finite numbers >= 0");
}

/// What only some realisations can do.
void requireCombination(const FmbpcParams& p) {
  const std::string& realisation = p.realisation;
  require(realisation == "parallel" || realisation == "realigned" || realisation == "literal" ||
              realisation == "observer",
          "controller.realisation",
          "one of parallel, realigned, literal, observer, got '" + realisation + "'");
  require(p.delay_steps >= 0 && p.delay_steps <= 1000, "controller.delay_steps",
          "an integer from 0 to 1000");
  require(p.delay_steps == 0 || realisation != "realigned", "controller.delay_steps",
          "0 for realisation realigned, whose state comes from present measurements");
  require(p.reference_lead_steps >= 0 && p.reference_lead_steps <= 100000,
          "controller.reference_lead_steps", "an integer from 0 to 100000");
  require(p.law != "iterated" || (p.delay_steps == 0 && p.reference_lead_steps == 0),
          "controller.law", "published or general with delay_steps or reference_lead_steps");
  if (realisation != "literal") return;
  require(p.law == "published", "controller.law", "published for realisation literal");
  require(p.antecedent == "measured", "controller.antecedent", "measured for realisation literal");
}

void requireOneOf(const std::string& value, const std::string& first, const std::string& second,
                  const std::string& key) {
  require(value == first || value == second, key,
          "one of " + first + ", " + second + ", got '" + value + "'");
}

}  // namespace

void FmbpcParams::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  require(law == "published" || law == "general" || law == "iterated", "controller.law",
          "one of published, general, iterated, got '" + law + "'");
  requireOneOf(antecedent, "model", "measured", "controller.antecedent");
  requireCombination(*this);
  if (realisation == "observer") observer.validate(n_y);
  require(coincidence_steps >= 1 && coincidence_steps <= 100000, "controller.coincidence_steps",
          "an integer from 1 to 100000");
  require(prediction_steps >= 1 && prediction_steps <= 100000, "controller.prediction_steps",
          "an integer from 1 to 100000");
  require(reference_pole.size() == n_y, "controller.reference_pole",
          std::to_string(n_y) + " numbers");
  for (Eigen::Index i = 0; i < n_y; ++i)
    require(reference_pole[i] >= 0.0 && reference_pole[i] < 1.0, "controller.reference_pole",
            "numbers >= 0 and < 1");
  require(offset_gain >= 0.0 && offset_gain <= 1.0, "controller.offset_gain",
          "a number from 0 to 1");
  require(transfer_decay >= 0.0 && transfer_decay < 1.0, "controller.transfer_decay",
          "a number >= 0 and < 1");
  require(disturbance_nominal.allFinite(), "controller.disturbance_nominal", "finite numbers");
  if (law == "published") {
    require(n_u == 1, "controller.law",
            "general for a plant with " + std::to_string(n_u) + " inputs; published has one");
    return;
  }
  require(horizon_steps >= 1 && horizon_steps <= 10000, "controller.horizon_steps",
          "an integer from 1 to 10000");
  require(iterations >= 1 && iterations <= 1000, "controller.iterations",
          "an integer from 1 to 1000");
  requireWeights(weight_output, n_y, "controller.weight_output");
  requireWeights(weight_move, n_u, "controller.weight_move");
  require((weight_output.array() > 0.0).any(), "controller.weight_output",
          "at least one number > 0");
}

Eigen::Index FmbpcParams::referenceSteps() const {
  const int aimed = prediction_steps + coincidence_steps - 1 + reference_lead_steps;
  return std::max(aimed, law == "iterated" ? horizon_steps : 1);
}

}  // namespace fpc
