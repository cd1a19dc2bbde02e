#include "random/random_loop.hpp"

#include <algorithm>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/registry.hpp"
#include "random/random_parts.hpp"

namespace fpc {
namespace {

/// What a controller can run: plant and model belong together, as does the sample time. Without a
/// model the controllers are those of the plant; none: any that needs none. A plant that is not
/// here is one of the last kind.
struct Modelled {
  std::string plant, model;
  std::vector<std::string> outputs, disturbances, controllers;
};

std::vector<Modelled> modelledPlants() {
  return {{"activated_sludge", "fm_1", {"s", "x"}, {"q_i", "s_i"}, {"fmbpc", "swarm_mpc"}},
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
          {"bsm1_air", "", {"S_NH5"}, {"S_NH_in", "Q_in"}, {"pi"}},
          {"distillation_column", "", {"y_D", "x_B"}, {}, {"adaptive_pi"}}};
}

const std::vector<Modelled>& allPlants() {
  static const std::vector<Modelled> all = [] {
    std::vector<Modelled> plants = modelledPlants();
    const std::size_t modelled = plants.size();
    for (const std::string& name : plantNames()) {
      const auto end = plants.begin() + static_cast<std::ptrdiff_t>(modelled);
      const bool known =
          std::any_of(plants.begin(), end, [&](const Modelled& row) { return row.plant == name; });
      if (!known) plants.push_back({name, "", {}, {}, {}});
    }
    return plants;
  }();
  return all;
}

/// At which a plant and its models are sampled; a plant that is not here as in its first shipped
/// loop, or ten times in its unit of time.
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
  if (found != known.end()) return found->second;
  const double shipped = shippedSampleTime(plant.name);
  return shipped > 0.0 ? shipped : 0.1 * plant.time_unit_s;
}

/// A PI or a law with the loop's model, as a section of its own; not one that searches at length.
std::string randomFallback(Dice& dice, RandomFrame frame, std::vector<std::string> types) {
  types.erase(std::remove(types.begin(), types.end(), "swarm_mpc"), types.end());
  types.resize(types.size() + 2, "pi");
  return randomController(dice.pick(types), dice, frame);
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
  // the states say everything, and are few: those that nobody measures are simulated
  const bool foreseen = !frame.remembers && frame.plant.states.size() < 20 && !frame.delayed;
  if (foreseen) types.emplace_back("nmpc");
  return dice.pick(types);
}

void askStepper(const Plant& plant, RandomFrame& frame) {
  const auto stepper = plant.makeStepper(frame.sample_time_s);
  frame.divisible = !stepper || stepper->divisible();
  frame.remembers = stepper && stepper->remembers();
}

/// Longer and shorter samples, if the plant can be moved over them.
void changeSampleTime(Dice& dice, const Plant& plant, RandomFrame& frame) {
  const double usual = frame.sample_time_s;
  const std::vector<double> whole{1.0, 2.0, 5.0}, any{1.0, 1.0, 0.5, 2.0, 1.0 / 3.0};
  frame.sample_time_s *= dice.pick(frame.divisible ? any : whole);
  try {
    askStepper(plant, frame);
  } catch (const InputError&) {
    frame.sample_time_s = usual;
  }
}

}  // namespace

std::string RandomLoop::told() const {
  std::string all = "seed " + std::to_string(seed) +
                    ", to run it alone: FMBPC_RANDOM_SEED=" + std::to_string(seed) +
                    " test_random\n--- loop file\n" + text;
  for (const auto& [name, content] : files) all += "--- " + name + "\n" + content;
  return all + "---\n";
}

RandomLoop randomLoop(std::uint64_t seed, const std::vector<std::string>& shipped) {
  Dice dice(seed);
  if (!shipped.empty() && dice.chance(std::min(0.5, 0.1 * static_cast<double>(shipped.size()))))
    return randomShippedLoop(dice.pick(shipped), seed);
  if (dice.chance(0.15)) return randomMatrixLoop(seed);
  RandomLoop loop;
  RandomFrame frame;
  loop.seed = seed;
  const bool as_said = dice.chance(0.6);
  const Modelled& modelled = dice.pick(allPlants());
  const bool given = !modelled.controllers.empty() && (as_said || modelled.model.empty());
  const bool has_model = given && !modelled.model.empty();
  loop.plant = modelled.plant;
  const auto process = makePlant(loop.plant);
  frame.plant = process->description();
  if (has_model) frame.model = modelled.model;
  loop.outputs = given ? modelled.outputs : frame.plant.outputs;
  for (const auto& name : loop.outputs) frame.outputs.push_back(stateOf(frame.plant, name));
  frame.sample_time_s = usualSampleTime(frame.plant);
  frame.samples = dice.whole(10, 40);
  askStepper(*process, frame);
  if (!has_model) changeSampleTime(dice, *process, frame);
  const std::string line = sampleLine(dice, frame);
  loop.controller = given ? dice.pick(modelled.controllers) : controllerFor(dice, frame);
  std::string plant =
      "plant:\n  type: " + loop.plant + "\n  outputs: " + listed(loop.outputs) + "\n";
  if (given) plant += "  measured_disturbances: " + listed(modelled.disturbances) + "\n";
  const std::string controller = randomController(loop.controller, dice, frame);
  const ControllerType& type = controllerType(loop.controller);
  // moves are not shrunk where the law names the few positions of its actuators
  const bool guarded = type.needs_model && frame.actuator.empty();
  const std::string guard =
      guarded ? randomGuard(dice, frame, randomFallback(dice, frame, modelled.controllers))
              : std::string();
  loop.text = "title: Random loop " + std::to_string(seed) + "\n" + plant +
              "sampling:\n  sample_time_s: " + exactText(frame.sample_time_s) +
              "\n  duration_h: " + exactText(frame.hours(frame.samples)) + "\n" +
              randomSetpoint(dice, frame) + randomDisturbance(dice, frame, loop) +
              randomNoise(dice, frame) + randomSensors(dice, frame) + line +
              randomModel(dice, frame) + randomPlausibility(dice, frame) +
              randomStandstill(dice, frame) + guard +
              (frame.actuator.empty() ? randomActuator(dice, frame) : frame.actuator) + controller +
              (type.predicts && dice.chance(0.4) ? randomClp(dice, frame) : std::string());
  return loop;
}

}  // namespace fpc
