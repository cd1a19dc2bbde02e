#include "random/random_loop.hpp"

#include <algorithm>

#include "random/random_parts.hpp"

namespace fpc {
namespace {

/// What a controller can run: plant and model belong together, as does the sample time. Without a
/// model the controllers are those of the plant; none: any that needs none.
struct Modelled {
  std::string plant, model;
  std::vector<std::string> outputs, disturbances, controllers;
};

const std::vector<Modelled>& modelledPlants() {
  static const std::vector<Modelled> all{
      {"activated_sludge", "fm_1", {"s", "x"}, {"q_i", "s_i"}, {"fmbpc", "swarm_mpc"}},
      {"activated_sludge", "asp_c", {"s", "x"}, {"q_i", "s_i"}, {"fmbpc", "swarm_mpc"}},
      {"activated_sludge", "asp_xr", {"s", "x_r", "x"}, {"q_i", "s_i"}, {"fmbpc"}},
      {"cstr", "cstr_a", {"CA"}, {}, {"fmbpc"}},
      {"cstr", "cstr_own", {"CA"}, {}, {"fmbpc", "swarm_mpc"}},
      {"mimo_cstr", "mimo_cstr", {"Ca", "T"}, {}, {"fuzzy_optimal", "fmbpc", "swarm_mpc"}},
      {"surge_tank", "surge_tank", {"H"}, {}, {"fuzzy_optimal", "fmbpc", "swarm_mpc"}},
      {"linear_2x2", "linear_2x2_exact", {"y1", "y2"}, {}, {"fuzzy_optimal", "fmbpc"}},
      {"distillation_column", "wood_berry", {"y_D", "x_B"}, {}, {"fuzzy_optimal", "fmbpc"}},
      {"batch_reactor", "batch_fuzzy", {"T", "Tw"}, {}, {"hybrid_mpc"}},
      {"bsm1_air", "bsm1_air", {"S_NH5"}, {"S_NH_in", "Q_in"}, {"fmbpc", "swarm_mpc"}},
      {"bsm1_air", "bsm1_nitrate", {"S_NH5", "S_NO2", "S_NO5"}, {"S_NH_in", "Q_in"}, {"fmbpc"}},
      {"bsm1_air", "", {"S_NH5"}, {"S_NH_in", "Q_in"}, {"load_supervisor"}},
      {"distillation_column", "", {"y_D", "x_B"}, {}, {"adaptive_pi"}},
      {"bsm1", "", {}, {}, {}},
      {"bsm1_pi", "", {}, {}, {}}};
  return all;
}

/// At which a plant is usually sampled.
double usualSampleTime(const PlantDescription& plant) {
  static const std::map<std::string, double> known{{"activated_sludge", 720},
                                                   {"batch_reactor", 10},
                                                   {"cstr", 6},
                                                   {"distillation_column", 60},
                                                   {"linear_2x2", 1},
                                                   {"mimo_cstr", 0.6},
                                                   {"surge_tank", 0.1},
                                                   {"bsm1", 60},
                                                   {"bsm1_pi", 300},
                                                   {"bsm1_air", 900}};
  const auto found = known.find(plant.name);
  return found != known.end() ? found->second : 0.1 * plant.time_unit_s;
}

std::string listed(const std::vector<std::string>& names) { return "[" + join(names) + "]"; }

const Quantity& stateOf(const PlantDescription& plant, const std::string& name) {
  return *std::find_if(plant.states.begin(), plant.states.end(),
                       [&](const Quantity& q) { return q.name == name; });
}

std::string sampleLine(Dice& dice, RandomFrame& frame) {
  const auto& frames = frame.plant.frames;
  if (frames.size() < 3 || !dice.chance(0.2)) return "";
  frame.delayed = true;
  return "tf:\n  sample_lines:\n    - {output: " + frame.outputs.front().name +
         ", from: " + frames[1].name + ", to: " + frames.back().name +
         ", velocity_m_s: " + dice.number(0.01, 5.0) + "}\n";
}

std::string controllerFor(Dice& dice, RandomFrame& frame) {
  std::vector<std::string> types{"pi", "excitation"};
  const std::string& plant = frame.plant.name;
  const bool foreseen = plant != "distillation_column" && plant != "linear_2x2" &&
                        plant.rfind("bsm1", 0) != 0 && !frame.delayed;
  if (foreseen) types.emplace_back("nmpc");
  return dice.pick(types);
}

bool predictsByRules(const std::string& type) {
  return type == "fmbpc" || type == "fuzzy_optimal" || type == "swarm_mpc";
}

}  // namespace

std::string RandomLoop::told() const {
  std::string all = "seed " + std::to_string(seed) +
                    ", to run it alone: FMBPC_RANDOM_SEED=" + std::to_string(seed) +
                    " test_random\n--- loop file\n" + text;
  for (const auto& [name, content] : files) all += "--- " + name + "\n" + content;
  return all + "---\n";
}

RandomLoop randomLoop(std::uint64_t seed) {
  Dice dice(seed);
  if (dice.chance(0.15)) return randomMatrixLoop(seed);
  RandomLoop loop;
  RandomFrame frame;
  loop.seed = seed;
  const bool as_said = dice.chance(0.6);
  const Modelled& modelled = dice.pick(modelledPlants());
  const bool given = !modelled.controllers.empty() && (as_said || modelled.model.empty());
  const bool has_model = given && !modelled.model.empty();
  loop.plant = modelled.plant;
  frame.plant = makePlant(loop.plant)->description();
  if (has_model) frame.model = modelled.model;
  loop.outputs = given ? modelled.outputs : frame.plant.outputs;
  for (const auto& name : loop.outputs) frame.outputs.push_back(stateOf(frame.plant, name));
  frame.sample_time_s = usualSampleTime(frame.plant);
  frame.samples = dice.whole(10, 40);
  if (!has_model && loop.plant == "surge_tank")  // a difference equation of 0.1 s, or finer
    frame.sample_time_s *= dice.pick<double>({1.0, 2.0, 5.0});
  else if (!has_model && loop.plant != "linear_2x2")
    frame.sample_time_s *= dice.pick<double>({1.0, 1.0, 0.5, 2.0, 1.0 / 3.0});
  const std::string line = sampleLine(dice, frame);
  loop.controller = given ? dice.pick(modelled.controllers) : controllerFor(dice, frame);
  std::string plant =
      "plant:\n  type: " + loop.plant + "\n  outputs: " + listed(loop.outputs) + "\n";
  if (given) plant += "  measured_disturbances: " + listed(modelled.disturbances) + "\n";
  const std::string controller = randomController(loop.controller, dice, frame);
  const bool guarded = predictsByRules(loop.controller);
  const std::string guard =
      guarded ? randomGuard(dice, frame, randomPiKeys(dice, frame)) : std::string();
  const bool predicts = loop.controller == "fmbpc" || loop.controller == "fuzzy_optimal";
  loop.text = "title: Random loop " + std::to_string(seed) + "\n" + plant +
              "sampling:\n  sample_time_s: " + exactText(frame.sample_time_s) +
              "\n  duration_h: " + exactText(frame.hours(frame.samples)) + "\n" +
              randomSetpoint(dice, frame) + randomDisturbance(dice, frame, loop) +
              randomNoise(dice, frame) + randomSensors(dice, frame) + line +
              randomModel(dice, frame) + randomPlausibility(dice, frame) +
              randomStandstill(dice, frame) + guard +
              (loop.controller == "hybrid_mpc" ? "actuator: {initial: {kM: 0, kC: 0, kH: 1}}\n"
                                               : randomActuator(dice, frame)) +
              controller + (predicts && dice.chance(0.4) ? randomClp(dice, frame) : std::string());
  return loop;
}

}  // namespace fpc
