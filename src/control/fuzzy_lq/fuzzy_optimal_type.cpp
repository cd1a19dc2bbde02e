// Controller type fuzzy_optimal: its section of a loop file, with horizons, weights of all rules or
// of each, and what becomes of the disturbance estimate; its settings that may change in a run.
#include "control/fuzzy_lq/law.hpp"
#include "control/read_observer.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

void readWeights(YamlSection& section, QuadraticWeights& weights, const ControllerContext& loop) {
  section.byName("weight_output", weights.output, loop.outputs(), kFiniteNotNegative);
  section.byName("weight_move", weights.move, loop.inputs(), kFiniteNotNegative);
}

void readTuning(YamlSection& section, const ControllerContext& loop, FuzzyOptimalTuning& tuning) {
  const Eigen::Index n_y = loop.outputCount(), n_u = loop.inputCount();
  tuning.weight = {Vector::Ones(n_y), Vector::Zero(n_u), Vector::Zero(n_u)};
  tuning.input_target = loop.initial_input;
  section.integer("horizon_steps", tuning.horizon_steps, 1, 1000);
  section.integer("move_steps", tuning.move_steps, 1, 1000);
  readWeights(section, tuning.weight, loop);
  section.byName("weight_input", tuning.weight.input, loop.inputs(), kFiniteNotNegative);
  for (auto& item : section.list("rules")) {
    tuning.rules.push_back(tuning.weight);
    readWeights(item, tuning.rules.back(), loop);
    item.finish();
  }
  section.byName("input_target", tuning.input_target, loop.inputs(), kFinite);
}

FuzzyOptimalParams readFuzzyOptimal(YamlSection& section, const ControllerContext& loop) {
  FuzzyOptimalParams params;
  readTuning(section, loop, params.tuning);
  readPredictiveLaw(section, loop, params);
  readOption(section, "solve", params.solve);
  readOption(section, "disturbance", params.disturbance);
  params.observe = readObserver(section, params.observer, loop) &&
                   params.disturbance == FuzzyOptimalDisturbance::kInside;
  checked(section, [&] { params.validate(loop.outputCount(), loop.inputCount()); });
  return params;
}

std::unique_ptr<Controller> makeFuzzyOptimal(const FuzzyOptimalParams& params,
                                             const ControllerContext& loop) {
  return std::make_unique<FuzzyOptimalLaw>(params, loop.limits, loop.plant);
}

void checkModel(const FuzzyOptimalParams& params, const TsModel& model, const ControllerContext&) {
  FuzzyOptimalLaw::check(params, model);
}

SignalUse usedByFuzzyOptimal(const FuzzyOptimalParams& params, const ControllerContext& loop) {
  SignalUse use = everySignal(loop);
  use.followed = weighted(params.tuning.weight.output);
  return use;
}

ControllerType describeFuzzyOptimal() {
  ControllerType type{"fuzzy_optimal", "a quadratic predictive law for every rule, blended"};
  type.needs_model = true;
  type.predicts = true;
  type.settings = fuzzyOptimalSettings().infos();
  return type;
}

const bool kFuzzyOptimalRegistered =
    registerController<FuzzyOptimalParams>({describeFuzzyOptimal(), &readFuzzyOptimal,
                                            &makeFuzzyOptimal, &checkModel, &usedByFuzzyOptimal});

}  // namespace
}  // namespace fpc
