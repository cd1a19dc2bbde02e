// Checks of the parameters of the fuzzy model-based predictive law.
#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/require_numbers.hpp"
#include "control/fmbpc/law.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// What only some realisations can do.
void requireCombination(const FmbpcParams& p) {
  const bool literal = p.realisation == FmbpcRealisation::kLiteral;
  require(p.delay_steps >= 0 && p.delay_steps <= 1000, "controller.delay_steps",
          "an integer from 0 to 1000");
  require(p.delay_steps == 0 || p.realisation != FmbpcRealisation::kRealigned,
          "controller.delay_steps",
          "0 for realisation realigned, whose state comes from present measurements");
  require(p.reference_lead_steps >= 0 && p.reference_lead_steps <= 100000,
          "controller.reference_lead_steps", "an integer from 0 to 100000");
  require(p.observer.estimated.empty() || p.realisation == FmbpcRealisation::kObserver,
          "controller.realisation", "observer where controller.observer.estimated asks for one");
  require(!literal || p.law == FmbpcForm::kPublished, "controller.law",
          "published for realisation literal");
}

}  // namespace

const char* lawsInsteadOf(FmbpcForm law, const std::string& key) {
  const auto among = [&](std::initializer_list<const char*> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (law != FmbpcForm::kIterated && among({"horizon_steps", "iterations", "forecast_period_h",
                                            "forecast_memory_h", "weight_input", "input_target"}))
    return "law iterated with it";
  if (law == FmbpcForm::kPublished && among({"weight_output", "weight_move"}))
    return "law general or iterated with it";
  if (law == FmbpcForm::kIterated && key == "coincidence_steps")
    return "law published or general with it";
  return nullptr;
}

void FmbpcParams::validate(Eigen::Index n_y, Eigen::Index n_u) const {
  PredictiveLawParams::validate(n_y);
  requireCombination(*this);
  if (realisation == FmbpcRealisation::kObserver) observer.validate(n_y);
  require(coincidence_steps >= 1 && coincidence_steps <= 100000, "controller.coincidence_steps",
          "an integer from 1 to 100000");
  require(offset_gain >= 0.0 && offset_gain <= 1.0, "offset_gain", "a number from 0 to 1");
  for (const auto& [key, weight] :
       {std::pair{"weight_output", &weight_output}, std::pair{"weight_move", &weight_move}})
    requireNonNegative(*weight, weight->size(), std::string("controller.") + key);
  if (law == FmbpcForm::kPublished) {
    require(n_u == 1, "controller.law",
            "general for a plant with " + std::to_string(n_u) + " inputs; published has one");
    return;
  }
  require(horizon_steps >= 1 && horizon_steps <= 10000, "controller.horizon_steps",
          "an integer from 1 to 10000");
  require(iterations >= 1 && iterations <= 1000, "controller.iterations",
          "an integer from 1 to 1000");
  requireNonNegative(weight_output, n_y, "controller.weight_output");
  requireNonNegative(weight_move, n_u, "controller.weight_move");
  if (weight_input.size() > 0 || input_target.size() > 0) {
    requireNonNegative(weight_input, n_u, "controller.weight_input");
    require(input_target.size() == n_u && input_target.allFinite(), "controller.input_target",
            std::to_string(n_u) + " finite numbers");
    require(law == FmbpcForm::kIterated || weight_input.isZero(0.0), "controller.weight_input",
            "0 for a law other than iterated");
  }
  require((weight_output.array() > 0.0).any(), "controller.weight_output",
          "at least one number > 0");
}

Eigen::Index FmbpcParams::aimedColumn() const {
  return coincidence_steps - 1 + reference_lead_steps;
}

Eigen::Index FmbpcParams::referenceSteps() const {
  return std::max<Eigen::Index>(
      prediction_steps + aimedColumn(),
      law == FmbpcForm::kIterated ? horizon_steps + reference_lead_steps : 1);
}

}  // namespace fpc
