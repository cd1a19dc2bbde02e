// Section `controller` of a random loop file, by type.
#include <algorithm>
#include <map>
#include <regex>

#include "random/random_parts.hpp"

namespace fpc {
namespace {

double spanOf(const Quantity& q) {
  const auto [lower, upper] = workingRange(q);
  return upper - lower;
}

std::vector<std::string> weights(Dice& dice, const std::vector<Quantity>& signals) {
  std::vector<std::string> list;
  for (const auto& q : signals)
    list.push_back(Dice::rounded(dice.scale(0.1, 10.0) / (spanOf(q) * spanOf(q))));
  return list;
}

std::string costs(Dice& dice, const RandomFrame& frame, bool move_needed) {
  std::vector<std::string> poles;
  for (std::size_t i = 0; i < frame.outputs.size(); ++i) poles.push_back(dice.number(0.0, 0.98));
  std::string text =
      "  weight_output: " + byName(namesOf(frame.outputs), weights(dice, frame.outputs)) + "\n";
  if (move_needed || dice.chance(0.7))
    text +=
        "  weight_move: " + byName(namesOf(frame.plant.inputs), weights(dice, frame.plant.inputs)) +
        "\n";
  if (dice.chance(0.7)) text += "  reference_pole: " + byName(namesOf(frame.outputs), poles) + "\n";
  if (dice.chance(0.3)) text += "  preview: true\n";
  return text;
}

std::string horizon(Dice& dice, int longest) {
  const int steps = dice.whole(1, longest);
  return "  horizon_steps: " + std::to_string(steps) +
         "\n  move_steps: " + std::to_string(dice.whole(1, std::min(steps, 3))) + "\n";
}

std::string derivative(Dice& dice, const RandomFrame& frame, double kp) {
  std::string text;
  if (dice.chance(0.2))
    text += ", kd_h: " + Dice::rounded(kp * frame.hours(dice.scale(0.1, 5.0))) +
            ", derivative_lag_h: " + exactText(frame.hours(dice.whole(0, 5)));
  if (dice.chance(0.2)) text += ", preview_h: " + exactText(frame.hours(dice.whole(0, 5)));
  if (dice.chance(0.2))
    text += ", setpoint_pole: " + dice.number(0.0, 0.98) +
            ", setpoint_lead_h: " + exactText(frame.hours(dice.whole(0, 5)));
  return text;
}

/// Of plants that have a load to be fed forward.
std::string loadAhead(Dice& dice, const RandomFrame& frame, const Quantity& u) {
  const auto has = [&](const char* name) {
    const auto& all = frame.plant.disturbances;
    return std::any_of(all.begin(), all.end(), [&](const auto& d) { return d.name == name; });
  };
  if (!has("S_NH_in") || !has("Q_in") || dice.chance(0.3)) return "";
  return ", feedforward: [{disturbance: S_NH_in, times: Q_in, gain: " +
         Dice::rounded(spanOf(u) * dice.between(-1.0, 2.0) / 6e5) + "}]";
}

std::string pi(Dice& dice, RandomFrame& frame) {
  std::string text = "  loops:\n";
  const auto& inputs = frame.plant.inputs;
  for (std::size_t i = 0; i < std::min(inputs.size(), frame.outputs.size()); ++i) {
    const Quantity& u = inputs[i];
    const Quantity& y = frame.outputs[i];
    const double kp =
        spanOf(u) / spanOf(y) * dice.scale(0.01, 3.0) * (dice.chance(0.3) ? -1.0 : 1.0);
    const double ki = kp / frame.hours(dice.scale(1.0, 100.0));
    text += "    - {input: " + u.name + ", output: " + y.name + ", kp: " + Dice::rounded(kp);
    if (dice.chance(0.8)) text += ", ki_per_h: " + Dice::rounded(ki);
    if (dice.chance(0.3)) text += ", reverse: true";
    const auto anti_windup = dice.pick<std::string>({"none", "clamp", "tracking"});
    text += ", anti_windup: " + anti_windup +
            ", start: " + dice.pick<std::string>({"bias", "bumpless"});
    if (anti_windup == "tracking" && dice.chance(0.5))
      text += ", tracking_time_h: " + Dice::rounded(frame.hours(dice.scale(1.0, 200.0)));
    if (dice.chance(0.2))
      text += ", gain_schedule: [[" + exactText(workingRange(y).first) + ", " +
              dice.number(0.2, 2.0) + "], [" + exactText(workingRange(y).second) + ", " +
              dice.number(0.2, 2.0) + "]]";
    text += derivative(dice, frame, kp) + loadAhead(dice, frame, u) + "}\n";
  }
  return text;
}

std::string excitation(Dice& dice, RandomFrame& frame) {
  std::string text = "  signals:\n";
  for (const auto& u : frame.plant.inputs) {
    const auto kind = dice.pick<std::string>({"prbs", "multi_level", "steps", "none"});
    text += "    - {input: " + u.name + ", signal: " + kind;
    if (kind == "prbs") text += ", clock_s: " + exactText(dice.whole(1, 5) * frame.sample_time_s);
    if (kind == "multi_level") {
      const int shortest = dice.whole(1, 6);
      text += ", hold_s: [" + exactText(shortest * frame.sample_time_s) + ", " +
              exactText((shortest + dice.whole(0, 9)) * frame.sample_time_s) + "]";
    }
    if (kind == "steps")
      text += ", schedule: [{time_h: " + exactText(frame.hours(dice.whole(1, frame.samples))) +
              ", value: " + exactText(u.nominal) + "}]";
    text += "}\n";
  }
  return text;
}

std::string fmbpc(Dice& dice, RandomFrame& frame) {
  const bool single = frame.plant.inputs.size() == 1;
  const auto law =
      dice.pick<std::string>(single ? std::vector<std::string>{"published", "general", "iterated"}
                                    : std::vector<std::string>{"general", "iterated"});
  std::string text =
      "  law: " + law + "\n  coincidence_steps: " + std::to_string(dice.whole(1, 12)) + "\n";
  const std::string costly = costs(dice, frame, true);
  static const std::regex weight("  weight_[^\n]*\n");
  text += law == "published" ? std::regex_replace(costly, weight, "") : costly;
  const std::string observer = randomObserver(dice, frame);
  text += observer.empty()
              ? std::string("  realisation: ") + (dice.chance(0.7) ? "parallel\n" : "realigned\n")
              : "  realisation: observer\n" + observer;
  if (law == "iterated")
    text += "  horizon_steps: " + std::to_string(dice.whole(2, 12)) +
            "\n  iterations: " + std::to_string(dice.whole(1, 4)) + "\n";
  return text;
}

std::string fuzzyOptimal(Dice& dice, RandomFrame& frame) {
  return horizon(dice, 12) + costs(dice, frame, true) +
         "  solve: " + (dice.chance(0.8) ? "together" : "each") +
         "\n  disturbance: " + dice.pick<std::string>({"inside", "outside", "none"}) + "\n" +
         randomObserver(dice, frame);
}

std::string nmpc(Dice& dice, RandomFrame& frame) {
  return horizon(dice, 5) + costs(dice, frame, true) + randomObserver(dice, frame);
}

std::string swarm(Dice& dice, RandomFrame& frame) {
  return horizon(dice, 5) + costs(dice, frame, true) +
         "  swarm: {particles: " + std::to_string(dice.whole(2, 8)) +
         ", iterations: " + std::to_string(dice.whole(1, 6)) + "}\n" + randomObserver(dice, frame);
}

std::string hybrid(Dice& dice, RandomFrame& frame) {
  frame.actuator = "actuator: {initial: {kM: 0, kC: 0, kH: 1}}\n";
  std::vector<std::string> costs;
  for (std::size_t i = 0; i < frame.outputs.size(); ++i) costs.push_back(dice.number(0.0, 1.0));
  return "  inputs: [{kM: 0, kC: 0, kH: 1}, {kM: " + dice.number(0.01, 1.0) +
         ", kC: 0, kH: 1}, {kM: 1, kC: 1, kH: 0}]\n  hold_samples: " +
         std::to_string(dice.whole(1, 15)) +
         "\n  horizon_blocks: " + std::to_string(dice.whole(1, 4)) +
         "\n  bound: " + (dice.chance(0.5) ? "reach" : "cost") +
         "\n  cost:\n    tracking: " + byName(namesOf(frame.outputs), costs) + "\n";
}

/// The settings of the shipped loops, gains varied.
std::string adaptivePi(Dice& dice, RandomFrame&) {
  std::string text = "  loops:\n    - {input: L, output: y_D, kp: " + dice.number(0.1, 0.6) +
                     ", ki_per_h: " + dice.number(0.4, 1.6) +
                     "}\n    - {input: V, output: x_B, kp: " + dice.number(-0.15, -0.03) +
                     ", ki_per_h: " + dice.number(-0.4, -0.1) + "}\n" +
                     "  decoupling: " + (dice.chance(0.7) ? "true" : "false") + "\n  model:\n";
  const std::vector<std::string> elements{
      "output: y_D, from: L, gain: 12.8, time_constant_min: 16.7, dead_time_min: 1",
      "output: y_D, from: V, gain: -18.9, time_constant_min: 21, dead_time_min: 3",
      "output: x_B, from: L, gain: 6.6, time_constant_min: 10.9, dead_time_min: 7",
      "output: x_B, from: V, gain: -19.4, time_constant_min: 14.4, dead_time_min: 3"};
  for (const auto& element : elements) text += "    - {" + element + "}\n";
  if (dice.chance(0.5)) text += "  adaptation: {}\n";
  return text;
}

using Maker = std::string (*)(Dice&, RandomFrame&);

/// A type that is not here is drawn from its first shipped loop (shipped_loop.cpp).
const std::map<std::string, Maker>& makers() {
  static const std::map<std::string, Maker> all{{"pi", pi},
                                                {"excitation", excitation},
                                                {"fmbpc", fmbpc},
                                                {"nmpc", nmpc},
                                                {"swarm_mpc", swarm},
                                                {"hybrid_mpc", hybrid},
                                                {"adaptive_pi", adaptivePi},
                                                {"fuzzy_optimal", fuzzyOptimal}};
  return all;
}

}  // namespace

bool hasGenerator(const std::string& type) { return makers().count(type) > 0; }

std::string randomController(const std::string& type, Dice& dice, RandomFrame& frame) {
  return "controller:\n  type: " + type + "\n" + makers().at(type)(dice, frame);
}

}  // namespace fpc
