// Controller type fmbpc: its section of a loop file.
#include <algorithm>
#include <cmath>
#include <limits>

#include "control/fmbpc/law.hpp"
#include "control/read_observer.hpp"
#include "estimation/model_observer.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

void readWeights(YamlSection& section, const ControllerContext& loop, FmbpcParams& params) {
  params.weight_output = Vector::Ones(loop.outputCount());
  params.weight_move = Vector::Zero(loop.inputCount());
  section.byName("weight_output", params.weight_output, loop.outputs(), kFiniteNotNegative);
  section.byName("weight_move", params.weight_move, loop.inputs(), kFiniteNotNegative);
  params.weight_input = Vector::Zero(loop.inputCount());
  params.input_target = loop.initial_input;
  if (params.law != FmbpcForm::kIterated) return;
  section.byName("weight_input", params.weight_input, loop.inputs(), kFiniteNotNegative);
  section.byName("input_target", params.input_target, loop.inputs(), kFinite);
}

void readForecast(YamlSection& section, const ControllerContext& loop, FmbpcParams& params) {
  double period_h = 0.0;
  section.number("forecast_period_h", period_h, {0.0, 1e4});
  params.forecast_period_steps =
      static_cast<int>(std::lround(period_h * 3600.0 / loop.plant.sample_time_s));
  double memory_h = 0.0;
  section.number("forecast_memory_h", memory_h, {0.0, 1e4});
  params.forecast_memory_steps =
      static_cast<int>(std::lround(memory_h * 3600.0 / loop.plant.sample_time_s));
}

/// A horizon that an extended loop brings along for another law is no mistake.
void requireHeeded(const YamlSection& section, FmbpcForm law) {
  for (const std::string& key : section.keys())
    if (const char* instead = lawsInsteadOf(law, key))
      if (key != "coincidence_steps") section.fail(key, instead);
}

FmbpcParams readFmbpc(YamlSection& section, const ControllerContext& loop) {
  FmbpcParams params;
  readPredictiveLaw(section, loop, params);
  readOption(section, "law", params.law);
  requireHeeded(section, params.law);
  section.integer("coincidence_steps", params.coincidence_steps, 1, 100000);
  readWeights(section, loop, params);
  section.integer("horizon_steps", params.horizon_steps, 1, 10000);
  section.integer("iterations", params.iterations, 1, 1000);
  readForecast(section, loop, params);
  if (loop.quantised) params.realisation = FmbpcRealisation::kObserver;
  readOption(section, "realisation", params.realisation);
  section.integer("delay_steps", params.delay_steps, 0, 1000);
  section.integer("reference_lead_steps", params.reference_lead_steps, 0, 100000);
  readObserver(section, params.observer, loop, ObserverKey::kEstimated);
  checked(section, [&] { params.validate(loop.outputCount(), loop.inputCount()); });
  return params;
}

std::unique_ptr<Controller> makeFmbpc(const FmbpcParams& params, const ControllerContext& loop) {
  return std::make_unique<FmbpcLaw>(params, loop.limits, loop.plant);
}

/// The published law follows the last output, the others those with a weight. What of the rest is
/// needed its model says (ControllerSession).
SignalUse usedByFmbpc(const FmbpcParams& params, const ControllerContext& loop) {
  SignalUse use = everySignal(loop);
  if (params.law == FmbpcForm::kPublished)
    use.followed = {loop.outputCount() - 1};
  else
    use.followed = weighted(params.weight_output);
  use.estimated = namesOf(params.observer.estimated);
  use.looks_ahead = params.law == FmbpcForm::kIterated;
  return use;
}

/// A plan that ends before any input has moved an output cannot steer it; it counts without
/// delay_steps.
void requireReach(const FmbpcParams& params, const TsModel& model) {
  if (params.law != FmbpcForm::kIterated) return;
  for (std::size_t o = 0; o < model.submodels.size(); ++o) {
    if (params.weight_output[static_cast<Eigen::Index>(o)] == 0.0) continue;
    int soonest = std::numeric_limits<int>::max();
    for (const Regressor& regressor : model.submodels[o].regressors)
      if (regressor.kind == SignalKind::kInput) soonest = std::min(soonest, regressor.lag);
    if (soonest == std::numeric_limits<int>::max()) continue;
    const int dead_time = soonest - params.delay_steps;
    require(params.horizon_steps > dead_time, "controller.horizon_steps",
            "more samples than the dead time of " + model.outputs[o].name + " in the model, " +
                std::to_string(dead_time));
  }
}

void checkFmbpc(const FmbpcParams& params, const TsModel& model, const ControllerContext&) {
  requireReach(params, model);
  if (params.realisation == FmbpcRealisation::kObserver)
    ModelObserver(LocalModel(model), params.observer, 0);
}

ControllerType describeFmbpc() {
  ControllerType type{"fmbpc", "fuzzy model-based predictive control: an explicit law"};
  type.needs_model = true;
  type.predicts = true;
  type.settings = fmbpcSettings().infos();
  return type;
}

const bool kFmbpcRegistered = registerController<FmbpcParams>(
    {describeFmbpc(), &readFmbpc, &makeFmbpc, &checkFmbpc, &usedByFmbpc});

}  // namespace
}  // namespace fpc
