// Section `controller` of type fuzzy_optimal: horizons, weights of all rules or of each, and what
// becomes of the disturbance estimate.
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

Eigen::Index count(const std::vector<std::string>& names) {
  return static_cast<Eigen::Index>(names.size());
}

void readWeights(YamlSection& section, QuadraticWeights& weights, const LoopNames& names) {
  section.byName("weight_output", weights.output, names.outputs, kFiniteNotNegative);
  section.byName("weight_move", weights.move, names.inputs, kFiniteNotNegative);
  section.byName("weight_input", weights.input, names.inputs, kFiniteNotNegative);
}

void readTuning(YamlSection& section, const LoopFile& loop, FuzzyOptimalTuning& tuning,
                const LoopNames& names) {
  const Eigen::Index n_y = count(names.outputs), n_u = count(names.inputs);
  tuning.weight = {Vector::Ones(n_y), Vector::Zero(n_u), Vector::Zero(n_u)};
  tuning.input_target = loop.simulation.actuator.initial;
  section.integer("horizon_steps", tuning.horizon_steps, 1, 1000);
  section.integer("move_steps", tuning.move_steps, 1, 1000);
  readWeights(section, tuning.weight, names);
  for (auto& item : section.list("rules")) {
    tuning.rules.push_back(tuning.weight);
    readWeights(item, tuning.rules.back(), names);
    item.finish();
  }
  section.byName("input_target", tuning.input_target, names.inputs, kFinite);
}

}  // namespace

void readFuzzyOptimal(YamlSection& section, LoopFile& loop, const LoopNames& names) {
  FuzzyOptimalParams& params = loop.fuzzy_optimal;
  readTuning(section, loop, params.tuning, names);
  params.reference_pole = Vector::Constant(count(names.outputs), 0.9);
  params.disturbance_nominal = nominalDisturbances(loop, names);
  section.oneOf("solve", params.solve, {"together", "each"});
  section.oneOf("disturbance", params.disturbance, {"inside", "outside", "none"});
  section.number("disturbance_gain", params.disturbance_gain, {0.0, 1.0, true});
  section.byName("reference_pole", params.reference_pole, names.outputs, {0.0, 1.0});
  section.boolean("preview", params.preview);
  section.boolean("disturbance_feedforward", params.disturbance_feedforward);
  section.byName("disturbance_nominal", params.disturbance_nominal, names.seen_disturbances,
                 kFinite);
  section.number("transfer_decay", params.transfer_decay, {0.0, 1.0});
  readPredictionSteps(section, loop, params.prediction_steps);
  checked(section, [&] { params.validate(count(names.outputs), count(names.inputs)); });
}

}  // namespace fpc
