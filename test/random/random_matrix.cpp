// Random transfer matrices under PI or a predictive law, in any units.
#include "random/random_matrix.hpp"

#include "fmbpc/control/registry.hpp"
#include "random/random_parts.hpp"

namespace fpc {
namespace {

std::string quantity(const Quantity& q, double unit) {
  return "{name: " + q.name + ", unit: " + q.unit + ", nominal: " + exactText(q.nominal / unit) +
         ", lower: " + exactText(q.lower / unit) + ", upper: " + exactText(q.upper / unit) + "}";
}

Quantity signal(Dice& dice, const std::string& name) {
  const double nominal = dice.chance(0.3) ? 0.0 : std::stod(dice.number(1.0, 50.0));
  const double reach = std::stod(dice.number(5.0, 100.0));
  return {name, "-", nominal, nominal - reach, nominal + reach};
}

std::string values(const std::vector<Quantity>& signals, Dice& dice, double share, double unit,
                   bool from_nominal, double zero = 0.0) {
  std::string text = "{";
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const Quantity& q = signals[i];
    const double reach = share * (q.upper - q.nominal) * dice.between(0.1, 1.0);
    const double value = std::stod(Dice::rounded(from_nominal ? q.nominal + reach : reach));
    text += (i > 0 ? ", " : "") + q.name + ": " + exactText(i == 0 ? (value - zero) / unit : value);
  }
  return text + "}";
}

/// PI loops, or a law with a model beside the loop file.
std::string controller(Dice& dice, const MatrixSignals& signals, const std::string& pi_loops,
                       double sample_min, RandomLoop& loop) {
  loop.controller =
      dice.pick<std::string>({"pi", "pi", "pi", "fmbpc", "fmbpc", "fuzzy_optimal", "swarm_mpc"});
  if (!controllerType(loop.controller).needs_model)
    return "controller:\n  type: pi\n  loops:\n" + pi_loops;
  loop.files["model.yaml"] = matrixModel(dice, signals, 60.0 * sample_min);
  const std::string guard = loop.seed % 2 == 0 ? "guard: {lock_samples: 4}\n" : "";
  return "model: {file: model.yaml}\n" + guard + matrixLaw(dice, loop.controller, signals);
}

}  // namespace

// Only the first output and the first input change their units, so that a mix-up of the others
// shows.
RandomLoop randomMatrixLoop(std::uint64_t seed, double output_unit, double input_unit,
                            double output_zero) {
  Dice dice(seed + 1000000);
  RandomLoop loop;
  loop.seed = seed;
  loop.plant = "matrix";
  const int n_y = dice.whole(1, 3), n_u = dice.whole(1, 3), n_d = dice.whole(0, 2);
  std::vector<Quantity> outputs, inputs, loads;
  for (int i = 0; i < n_y; ++i) outputs.push_back(signal(dice, "y" + std::to_string(i)));
  for (int i = 0; i < n_u; ++i) inputs.push_back(signal(dice, "u" + std::to_string(i)));
  for (int i = 0; i < n_d; ++i) loads.push_back(signal(dice, "d" + std::to_string(i)));
  for (const auto& q : outputs) loop.outputs.push_back(q.name);
  const double sample_min = dice.pick<double>({0.25, 0.5, 1.0, 2.0, 1.0 / 3.0});
  const int samples = dice.whole(10, 40);
  std::string elements, loops;
  const auto element = [&](const std::string& y, const std::string& from, double unit,
                           double span) {
    const double gain = std::stod(dice.number(-2.0, 2.0)) * span;
    elements += "      - {output: " + y + ", from: " + from + ", gain: " + exactText(gain * unit) +
                ", time_constant_min: " + Dice::rounded(dice.scale(0.01, 100.0));
    if (dice.chance(0.6))
      elements += ", dead_time_min: " + Dice::rounded(sample_min * dice.between(0.0, 6.0));
    if (dice.chance(0.3))
      elements += ", second_time_constant_min: " + Dice::rounded(dice.scale(0.01, 100.0));
    elements += "}\n";
  };
  const auto unitOf = [](int i, double unit) { return i == 0 ? unit : 1.0; };
  for (int i = 0; i < n_y; ++i) {
    const Quantity& y = outputs[static_cast<std::size_t>(i)];
    for (int j = 0; j < n_u; ++j)
      if (j == i % n_u || dice.chance(0.4))
        element(y.name, inputs[static_cast<std::size_t>(j)].name,
                unitOf(j, input_unit) / unitOf(i, output_unit), 1.0);
    for (const auto& load : loads)
      if (dice.chance(0.5)) element(y.name, load.name, 1.0 / unitOf(i, output_unit), 0.3);
  }
  for (int i = 0; i < std::min(n_y, n_u); ++i) {
    const double kp =
        std::stod(Dice::rounded(dice.scale(0.01, 1.0) * (dice.chance(0.5) ? 1.0 : -1.0)));
    const double ki = std::stod(Dice::rounded(kp * dice.scale(0.5, 20.0)));
    const double unit = unitOf(i, output_unit) / unitOf(i, input_unit);
    loops += "    - {input: u" + std::to_string(i) + ", output: y" + std::to_string(i) +
             ", kp: " + exactText(kp * unit) + ", ki_per_h: " + exactText(ki * unit) +
             ", anti_windup: " + dice.pick<std::string>({"none", "clamp", "tracking"}) + "}\n";
  }
  const auto listOf = [](std::vector<Quantity> signals, double unit, double zero) {
    if (!signals.empty())
      for (double* value : {&signals[0].nominal, &signals[0].lower, &signals[0].upper})
        *value -= zero;
    std::string text = "[";
    for (std::size_t i = 0; i < signals.size(); ++i)
      text += (i > 0 ? ",\n              " : "") + quantity(signals[i], i == 0 ? unit : 1.0);
    return text + "]\n";
  };
  const double step = sample_min / 60.0;
  loop.text = "title: Random matrix " + std::to_string(seed) +
              "\nplant:\n  type: transfer_matrix\n  matrix:\n    outputs: " +
              listOf(outputs, output_unit, output_zero) +
              "    inputs: " + listOf(inputs, input_unit, 0.0);
  if (n_d > 0) loop.text += "    disturbances: " + listOf(loads, 1.0, 0.0);
  loop.text +=
      "    elements:\n" + elements + "sampling:\n  sample_time_s: " + exactText(60.0 * sample_min) +
      "\n  duration_h: " + exactText(samples * step) +
      "\nsetpoint:\n  initial: " + values(outputs, dice, 0.3, output_unit, true, output_zero) +
      "\nnoise:\n  std: " + values(outputs, dice, 0.01, output_unit, false) +
      "\nactuator:\n  move_upper: " + values(inputs, dice, 0.5, input_unit, false) +
      "\ndisturbance:\n  commands:\n";
  if (n_d > 0)
    loop.text +=
        "    - {time_h: " + exactText(step * dice.whole(0, samples)) + ", name: d0, value: " +
        Dice::rounded(loads[0].nominal + 0.3 * (loads[0].upper - loads[0].nominal)) + "}\n";
  loop.text += "    - {time_h: " + exactText(step * dice.whole(0, samples)) +
               ", name: output/y0, mode: offset, value: " +
               exactText(std::stod(dice.number(-1.0, 1.0)) / output_unit) + "}\n" +
               controller(dice, {outputs, inputs, output_unit, input_unit, output_zero}, loops,
                          sample_min, loop);
  return loop;
}

}  // namespace fpc
