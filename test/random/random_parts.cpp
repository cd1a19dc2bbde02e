#include "random/random_parts.hpp"

#include <algorithm>
#include <cmath>

namespace fpc {
namespace {

/// Disturbances that are signals, not gains of a matrix.
std::vector<Quantity> loadsOf(const PlantDescription& plant) {
  std::vector<Quantity> loads;
  for (const auto& q : plant.disturbances)
    if (q.name.find('/') == std::string::npos) loads.push_back(q);
  return loads;
}

std::string at(Dice& dice, const RandomFrame& frame) {
  return exactText(frame.hours(dice.chance(0.8) ? dice.whole(0, frame.samples)
                                                : dice.between(0.0, frame.samples)));
}

std::string pattern(Dice& dice, const std::vector<Quantity>& loads) {
  std::string text = "  pattern:\n    channels:\n";
  for (const auto& q : loads) {
    const auto [lower, upper] = workingRange(q);
    text += "      " + q.name + ": {shape: " + (dice.chance(0.5) ? "flow" : "load") + ", range: [" +
            exactText(lower) + ", " + exactText(upper) +
            "], mean: " + exactText(lower + (upper - lower) * dice.between(0.3, 0.7)) + "}\n";
  }
  return text;
}

/// A record with rounded times, a hole, missing and silly cells.
std::string record(Dice& dice, const std::vector<Quantity>& loads, const RandomFrame& frame,
                   RandomLoop& loop) {
  const bool german = dice.chance(0.3);
  const char separator = german ? ';' : ',';
  const auto cell = [&](double value) {
    std::string text = exactText(value);
    if (german) std::replace(text.begin(), text.end(), '.', ',');
    return text;
  };
  std::string csv = "t[h]", channels;
  for (const auto& q : loads) csv += separator + ("c_" + q.name);
  csv += "\n";
  const int rows = dice.whole(3, 12);
  const double interval = frame.hours(frame.samples) / (rows - 1.5);
  for (int r = 0; r < rows; ++r) {
    if (r == rows / 2 && dice.chance(0.3)) continue;
    csv += cell(std::round(r * interval * 1e7) / 1e7);
    for (const auto& q : loads) {
      const auto [lower, upper] = workingRange(q);
      const bool measured = r == 0 || dice.chance(0.85);
      csv += separator + (measured ? cell(dice.between(lower, upper))
                                   : std::string(dice.chance(0.5) ? "" : "Bad"));
    }
    csv += "\n";
  }
  loop.files["record.csv"] = csv;
  for (const auto& q : loads) channels += "      " + q.name + ": {column: c_" + q.name + "}\n";
  return std::string("  csv:\n    file: record.csv\n    time_column: t\n    missing: ") +
         (dice.chance(0.5) ? "hold" : "interpolate") + "\n    missing_values: [Bad]\n" +
         (german ? "    separator: semicolon\n    decimal: comma\n" : "") +
         "    interpolation: " + (dice.chance(0.5) ? "hold" : "linear") +
         "\n    end: " + (dice.chance(0.5) ? "hold" : "repeat") + "\n    channels:\n" + channels;
}

std::string command(Dice& dice, const std::string& name, const Quantity& q, double share,
                    const RandomFrame& frame) {
  const auto [lower, upper] = workingRange(q);
  const double kind = dice.between(0.0, 1.0);
  std::string text = "    - {time_h: " + at(dice, frame) + ", name: " + name;
  if (kind < 0.2) return text + ", mode: release}\n";
  if (kind < 0.5)
    return text + ", mode: offset, value: " +
           Dice::rounded(share * (upper - lower) * dice.between(-1.0, 1.0)) + "}\n";
  return text + ", value: " + exactText(dice.between(lower, upper)) + "}\n";
}

}  // namespace

std::pair<double, double> workingRange(const Quantity& q) {
  const double reach = q.nominal != 0.0 ? 0.4 * std::abs(q.nominal) : 0.2;
  const double lower = std::max(q.lower, q.nominal - reach);
  const double upper = std::min(q.upper, q.nominal + reach);
  return {lower, upper};
}

std::string byName(const std::vector<std::string>& names, const std::vector<std::string>& values) {
  std::string text = "{";
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i > 0 ? ", " : "") + names[i] + ": " + values[i];
  return text + "}";
}

std::string randomActuator(Dice& dice, const RandomFrame& frame) {
  std::vector<std::string> lower, upper, move, initial;
  for (const auto& q : frame.plant.inputs) {
    const auto [low, high] = workingRange(q);
    const double l = dice.between(low, 0.5 * (low + q.nominal));
    const double u = dice.between(0.5 * (high + q.nominal), high);
    lower.push_back(exactText(l));
    upper.push_back(exactText(u));
    move.push_back(Dice::rounded((u - l) * dice.scale(0.01, 1.0)));
    initial.push_back(exactText(dice.between(l, u)));
  }
  const auto names = namesOf(frame.plant.inputs);
  std::string text = "actuator:\n  input_lower: " + byName(names, lower) +
                     "\n  input_upper: " + byName(names, upper) + "\n";
  if (dice.chance(0.5)) text += "  move_upper: " + byName(names, move) + "\n";
  if (dice.chance(0.7)) text += "  initial: " + byName(names, initial) + "\n";
  if (dice.chance(0.2)) text += "  hold_samples: " + std::to_string(dice.whole(-1, 5)) + "\n";
  return text + randomDrives(dice, frame);
}

std::string randomSetpoint(Dice& dice, const RandomFrame& frame) {
  const auto names = namesOf(frame.outputs);
  const auto values = [&] {
    std::vector<std::string> list;
    for (const auto& q : frame.outputs) {
      const auto [lower, upper] = workingRange(q);
      list.push_back(exactText(dice.between(0.5 * (lower + q.nominal), 0.5 * (upper + q.nominal))));
    }
    return list;
  };
  std::string text = "setpoint:\n  initial: " + byName(names, values()) + "\n";
  double time = 0.0;
  const int steps = dice.whole(0, 3);
  for (int i = 0; i < steps; ++i) {
    time = std::round(time + std::max(i > 0 ? 1.0 : 0.0, dice.between(0.0, 0.4) * frame.samples));
    const int ramp = dice.chance(0.15) ? dice.whole(1, 8) : 0;
    std::string entry = byName(names, values());
    entry.replace(0, 1,
                  "{time_h: " + exactText(frame.hours(time)) +
                      ", ramp_h: " + exactText(frame.hours(ramp)) + ", ");
    time += ramp;
    text += (i == 0 ? "  schedule:\n    - " : "    - ") + entry + "\n";
  }
  if (dice.chance(0.2)) {
    std::vector<std::string> rates;
    for (const auto& q : frame.outputs)
      rates.push_back(Dice::rounded((workingRange(q).second - workingRange(q).first) /
                                    frame.hours(frame.samples) * dice.scale(0.3, 10.0)));
    text += "  rate_per_h: " + byName(names, rates) + "\n";
  }
  if (dice.chance(0.15)) {  // narrower than what is asked
    std::vector<std::string> upper;
    for (const auto& q : frame.outputs)
      upper.push_back(exactText(dice.between(q.nominal, workingRange(q).second)));
    text += "  upper: " + byName(names, upper) + "\n";
  }
  if (dice.chance(0.2)) {
    const std::size_t i =
        static_cast<std::size_t>(dice.whole(0, static_cast<int>(names.size()) - 1));
    text += "  commands:\n" + command(dice, names[i], frame.outputs[i], 0.2, frame);
  }
  return text;
}

std::string randomDisturbance(Dice& dice, const RandomFrame& frame, RandomLoop& loop) {
  const auto loads = loadsOf(frame.plant);
  std::string text;
  const double source = dice.between(0.0, 1.0);
  const bool daily = frame.sample_time_s >= 5.0;  // a day's pattern is made at every sample time
  if (!loads.empty() && daily && source < 0.3)
    text += "  source: pattern\n" + pattern(dice, loads);
  else if (!loads.empty() && source < 0.6)
    text += "  source: csv\n" + record(dice, loads, frame, loop);
  std::string commands;
  if (!frame.plant.disturbances.empty() && dice.chance(0.4)) {
    const Quantity& q = dice.pick(frame.plant.disturbances);
    commands += command(dice, q.name, q, 0.3, frame);
  }
  if (dice.chance(0.2)) {
    const Quantity& q = dice.pick(frame.plant.inputs);
    commands += command(dice, "input/" + q.name, q, 0.3, frame);
  }
  if (dice.chance(0.2)) {
    const Quantity& q = dice.pick(frame.outputs);
    commands += command(dice, "output/" + q.name, q, 0.2, frame);
  }
  if (!commands.empty()) text += "  commands:\n" + commands;
  return text.empty() ? "" : "disturbance:\n" + text;
}

std::string randomNoise(Dice& dice, const RandomFrame& frame) {
  const std::string seed = "seed: " + std::to_string(dice.whole(0, 99)) + "\n";
  if (dice.chance(0.5)) return seed;
  std::vector<std::string> std;
  for (const auto& q : frame.outputs)
    std.push_back(Dice::rounded(0.01 * (workingRange(q).second - workingRange(q).first)));
  return seed + "noise:\n  std: " + byName(namesOf(frame.outputs), std) + "\n";
}

std::string randomClp(Dice& dice, const RandomFrame& frame) {
  std::string text = "clp:\n  perturbation_steps: " + std::to_string(dice.whole(1, 12)) + "\n";
  std::vector<std::string> weights, upper;
  for (const auto& q : frame.outputs) {
    weights.push_back(Dice::rounded(dice.scale(0.01, 10.0)));
    upper.push_back(exactText(workingRange(q).second));
  }
  if (dice.chance(0.5))
    text += "  weight_tracking: " + byName(namesOf(frame.outputs), weights) + "\n";
  if (dice.chance(0.4)) text += "  output_upper: " + byName(namesOf(frame.outputs), upper) + "\n";
  return text;
}

}  // namespace fpc
