// A predictive law with a model of rules for a random transfer matrix, in any units. The model is
// of the right size and no more: laws must live with that.
#include <cmath>
#include <map>

#include "fmbpc/control/registry.hpp"
#include "random/random_matrix.hpp"
#include "random/random_parts.hpp"

namespace fpc {
namespace {

double unitAt(std::size_t i, double unit) { return i == 0 ? unit : 1.0; }

std::string unitsOf(const std::vector<Quantity>& signals) {
  std::vector<std::string> units(signals.size(), "\"-\"");
  return byName(namesOf(signals), units);
}

/// One number for each signal, of its units to the power `power` (2: a weight of squares).
std::string scaled(Dice& dice, const std::vector<Quantity>& signals, double unit, double power,
                   double lower, double upper) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const double span = signals[i].upper - signals[i].lower;
    const double value = std::stod(Dice::rounded(dice.scale(lower, upper) / std::pow(span, power)));
    list.push_back(exactText(value * std::pow(unitAt(i, unit), power)));
  }
  return byName(namesOf(signals), list);
}

std::string delayedBy(const Quantity& signal, int delay) {
  return signal.name + (delay > 0 ? "(k-" + std::to_string(delay) + ")" : "(k)");
}

/// "then" of a rule for output i: one lag, gains of the order of the spans.
std::string consequent(Dice& dice, const MatrixSignals& s, std::size_t i,
                       const std::vector<int>& delays) {
  const double unit = unitAt(i, s.output_unit), pole = std::stod(dice.number(0.3, 0.98));
  double offset = (1.0 - pole) * (s.outputs[i].nominal - (i == 0 ? s.output_zero : 0.0));
  std::string text = "{" + s.outputs[i].name + "(k): " + exactText(pole);
  for (std::size_t j = 0; j < s.inputs.size(); ++j) {
    const double gain = (1.0 - pole) * std::stod(dice.number(-2.0, 2.0));
    offset -= gain * s.inputs[j].nominal;
    text += ", " + delayedBy(s.inputs[j], delays[j]) + ": " +
            exactText(gain * unitAt(j, s.input_unit) / unit);
  }
  return text + ", offset: " + exactText(offset / unit) + "}\n";
}

std::string submodel(Dice& dice, const MatrixSignals& s, std::size_t i, int rules) {
  const Quantity &y = s.outputs[i], &first = s.outputs.front();
  std::vector<int> delays;
  std::string regressors = y.name + "(k)";
  for (const Quantity& u : s.inputs) {
    delays.push_back(dice.whole(0, 2));
    regressors += ", " + delayedBy(u, delays.back());
  }
  std::string text = "  " + y.name + ":\n    antecedents: [" +
                     (rules > 1 ? first.name + "(k)" : std::string()) + "]\n    regressors: [" +
                     regressors + "]\n    rules:\n";
  for (int r = 0; r < rules; ++r) {
    const double centre =
        first.lower + (first.upper - first.lower) * (r + 1) / (rules + 1) - s.output_zero;
    const double width = 0.3 * (first.upper - first.lower);
    text += "      - ";
    if (rules > 1)
      text += "when: {" + first.name + "(k): {gaussian: [" + exactText(centre / s.output_unit) +
              ", " + exactText(width / s.output_unit) + "]}}\n        ";
    text += "then: " + consequent(dice, s, i, delays);
  }
  return text;
}

std::string rangesOf(std::vector<Quantity> signals, double unit, double zero = 0.0) {
  std::string text;
  signals[0].lower -= zero;
  signals[0].upper -= zero;
  for (std::size_t i = 0; i < signals.size(); ++i)
    text += "  " + signals[i].name + ": [" + exactText(signals[i].lower / unitAt(i, unit)) + ", " +
            exactText(signals[i].upper / unitAt(i, unit)) + "]\n";
  return text;
}

std::string generalKeys(Dice& dice) {
  return "  law: general\n  coincidence_steps: " + std::to_string(dice.whole(3, 12)) + "\n";
}

std::string horizonKeys(Dice& dice) {
  const int steps = dice.whole(3, 10);
  return "  horizon_steps: " + std::to_string(steps) +
         "\n  move_steps: " + std::to_string(dice.whole(1, 3)) + "\n";
}

std::string swarmKeys(Dice& dice) {
  return horizonKeys(dice) + "  swarm: {particles: 6, iterations: 5}\n";
}

std::string keysOf(Dice& dice, const std::string& type) {
  static const std::map<std::string, std::string (*)(Dice&)> makers{
      {"fmbpc", generalKeys}, {"fuzzy_optimal", horizonKeys}, {"swarm_mpc", swarmKeys}};
  return makers.at(type)(dice);
}

}  // namespace

std::string matrixModel(Dice& dice, const MatrixSignals& s, double sample_time_s) {
  const int rules = dice.whole(1, 3);
  std::string text = "name: random\nsample_time_s: " + exactText(sample_time_s) +
                     "\noutputs: " + unitsOf(s.outputs) + "\ninputs: " + unitsOf(s.inputs) +
                     "\ndisturbances: {}\nranges:\n" +
                     rangesOf(s.outputs, s.output_unit, s.output_zero) +
                     rangesOf(s.inputs, s.input_unit) + "submodels:\n";
  for (std::size_t i = 0; i < s.outputs.size(); ++i) text += submodel(dice, s, i, rules);
  return text;
}

std::string matrixLaw(Dice& dice, const std::string& type, const MatrixSignals& s) {
  std::string text = "controller:\n  type: " + type + "\n" + keysOf(dice, type) +
                     "  reference_pole: " + dice.number(0.3, 0.95) +
                     "\n  weight_output: " + scaled(dice, s.outputs, s.output_unit, 2.0, 0.5, 5.0) +
                     "\n  weight_move: " + scaled(dice, s.inputs, s.input_unit, 2.0, 0.05, 5.0) +
                     "\n";
  if (controllerType(type).predicts && dice.chance(0.4))
    text += "clp:\n  perturbation_steps: " + std::to_string(dice.whole(2, 8)) +
            "\n  weight_perturbation: " + scaled(dice, s.inputs, s.input_unit, 2.0, 0.5, 5.0) +
            "\n";
  return text;
}

}  // namespace fpc
