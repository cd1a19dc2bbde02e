// Sections of a random loop file that a loop can do without: instruments, doubts, guards, learning.
#include <algorithm>

#include "random/random_parts.hpp"

namespace fpc {
namespace {

double widthOf(const Quantity& q) {
  const auto [lower, upper] = workingRange(q);
  return upper - lower;
}

std::string hoursOf(Dice& dice, const RandomFrame& frame, int least, int most) {
  return exactText(frame.hours(dice.whole(least, most)));
}

std::string sensor(Dice& dice, const Quantity& q, const RandomFrame& frame) {
  const double Ts = frame.sample_time_s;
  std::vector<std::string> keys;
  if (Ts >= 60.0 && dice.chance(0.4))
    keys.push_back("class: " + dice.pick<std::string>({"A", "B0", "B1", "C0", "C1", "D"}));
  if (dice.chance(0.4)) keys.push_back("t90_s: " + Dice::rounded(Ts * dice.scale(0.1, 5.0)));
  if (dice.chance(0.2)) keys.push_back("delay_s: " + Dice::rounded(Ts * dice.between(0.0, 4.0)));
  if (dice.chance(0.2)) keys.push_back("interval_s: " + exactText(Ts * dice.whole(1, 4)));
  if (dice.chance(0.3)) keys.push_back("noise_std: " + Dice::rounded(0.01 * widthOf(q)));
  if (dice.chance(0.3)) keys.push_back("average: true");
  if (dice.chance(0.2)) {
    const int from = dice.whole(0, frame.samples);
    keys.push_back("stuck_h: [" + exactText(frame.hours(from)) + ", " +
                   exactText(frame.hours(from + dice.whole(1, 10))) + "]");
  }
  if (dice.chance(0.3)) {
    const double reach = std::max(q.upper - q.lower, 0.0);
    keys.push_back("range: [" + exactText(q.lower) + ", " +
                   exactText(std::isfinite(reach) ? q.upper : q.nominal + 1e6) + "]");
  }
  if (keys.empty()) keys.emplace_back("average: false");
  return "  " + q.name + ": {" + join(keys) + "}\n";
}

std::string doubts(Dice& dice, const Quantity& q, const RandomFrame& frame) {
  std::vector<std::string> keys{"substitute: " + dice.pick<std::string>({"hold", "last_good"})};
  if (dice.chance(0.5))
    keys.push_back("jump: " + Dice::rounded(widthOf(q) * dice.scale(0.02, 1.0)));
  if (dice.chance(0.3))
    keys.push_back("rate_per_h: " + Dice::rounded(widthOf(q) / frame.hours(dice.scale(1.0, 50.0))));
  if (dice.chance(0.4)) keys.push_back(dice.pick<std::string>({"frozen: false", "frozen: true"}));
  return "    " + q.name + ": {" + join(keys) + "}\n";
}

}  // namespace

std::string randomSensors(Dice& dice, const RandomFrame& frame) {
  if (!dice.chance(0.25)) return "";
  std::string text;
  if (frame.sample_time_s < 60.0 || dice.chance(0.5))
    text += "  step_s: " + exactText(frame.sample_time_s / dice.whole(1, frame.divisible ? 5 : 1)) +
            "\n";
  for (const Quantity& q : frame.outputs)
    if (dice.chance(0.6)) text += sensor(dice, q, frame);
  return text.empty() ? text : "sensors:\n" + text;
}

std::string randomDrives(Dice& dice, const RandomFrame& frame) {
  std::string text;
  if (!dice.chance(0.2)) return text;
  for (const Quantity& u : frame.plant.inputs)
    if (dice.chance(0.5))
      text += "    " + u.name +
              ": {t90_s: " + Dice::rounded(frame.sample_time_s * dice.scale(0.1, 5.0)) +
              ", order: " + std::to_string(dice.whole(1, 4)) + "}\n";
  return text.empty() ? text : "  lag:\n" + text;
}

std::string randomPlausibility(Dice& dice, const RandomFrame& frame) {
  if (!dice.chance(0.25)) return "";
  std::string text = "plausibility:\n  signals:\n";
  for (const Quantity& q : frame.outputs) text += doubts(dice, q, frame);
  if (!frame.model.empty() && dice.chance(0.4))
    text += "  reaction_samples: " + std::to_string(dice.whole(8, 15)) + "\n";
  return text;
}

std::string randomStandstill(Dice& dice, const RandomFrame& frame) {
  if (!dice.chance(0.1)) return "";
  std::string text = "standstill:\n  window_h: " + hoursOf(dice, frame, 1, 8) + "\n  signals: {";
  for (std::size_t i = 0; i < frame.outputs.size(); ++i)
    text += (i > 0 ? ", " : "") + frame.outputs[i].name + ": " +
            Dice::rounded(widthOf(frame.outputs[i]) * dice.scale(1e-6, 0.05));
  return text + "}\n";
}

std::string randomGuard(Dice& dice, const RandomFrame& frame, const std::string& fallback) {
  if (frame.model.empty() || !dice.chance(0.4)) return "";
  if (dice.chance(0.2)) return "guard: false\n";
  const double low = dice.between(0.05, 0.5);
  std::string text = "guard:\n  trust: [" + Dice::rounded(low) + ", " +
                     Dice::rounded(low + dice.between(0.1, 0.45)) + "]" +
                     "\n  lock_samples: " + std::to_string(dice.whole(0, 15)) +
                     "\n  return_samples: " + std::to_string(dice.whole(1, 10)) + "\n";
  if (!dice.chance(0.3)) return text;
  text += "  fallback:\n";
  for (std::size_t from = fallback.find('\n') + 1; from < fallback.size();) {
    const std::size_t to = fallback.find('\n', from);
    text += "  " + fallback.substr(from, to - from + 1);
    from = to + 1;
  }
  return text;
}

std::string randomObserver(Dice& dice, const RandomFrame& frame) {
  if (!dice.chance(0.25)) return "";
  std::vector<std::string> noise, change;
  for (const Quantity& q : frame.outputs) {
    noise.push_back(Dice::rounded(0.01 * widthOf(q) * dice.scale(0.1, 3.0)));
    change.push_back(Dice::rounded(0.01 * widthOf(q) * dice.scale(0.01, 3.0)));
  }
  const auto names = namesOf(frame.outputs);
  return "  observer: {noise_std: " + byName(names, noise) +
         ", disturbance_std: " + byName(names, change) + "}\n";
}

std::string randomModel(Dice& dice, const RandomFrame& frame) {
  if (frame.model.empty()) return "";
  std::string text = "model:\n  file: " + frame.model + ".yaml\n";
  if (!dice.chance(0.15)) return text;
  return text + "  identify:\n    online: {every: " + std::to_string(dice.whole(1, 12)) +
         ", forgetting: " + dice.number(0.9, 1.0) + "}\n";
}

}  // namespace fpc
