// A type of controller that has no generator of its own, on its first shipped loop: shorter, with
// noise and an actuator that does something else than it is told.
#include <algorithm>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/registry.hpp"
#include "random/random_parts.hpp"
#include "runtime/loops_of_type.hpp"

namespace fpc {
namespace {

Overrides shortened(Dice& dice, const LoopFile& shipped, RandomFrame& frame) {
  frame.sample_time_s = shipped.simulation.sample_time_s;
  frame.samples = dice.whole(10, 40);
  return {{"sampling.duration_h", exactText(frame.hours(frame.samples))},
          {"report.record_from_h", "0"}};
}

double spread(const Quantity& q) {
  const auto [lower, upper] = workingRange(q);
  return upper - lower;
}

std::pair<std::string, std::string> noiseOf(Dice& dice, const RandomFrame& frame,
                                            const std::vector<std::string>& outputs) {
  std::vector<std::string> names, std;
  for (const Quantity& q : frame.plant.states)
    if (std::find(outputs.begin(), outputs.end(), q.name) != outputs.end()) {
      names.push_back(q.name);
      std.push_back(Dice::rounded(spread(q) * dice.scale(0.0001, 0.01)));
    }
  return {"noise.std", byName(names, std)};
}

std::pair<std::string, std::string> offsetOf(Dice& dice, const RandomFrame& frame) {
  const Quantity& u = dice.pick(frame.plant.inputs);
  return {"disturbance.commands",
          "[{time_h: " + exactText(frame.hours(dice.whole(0, frame.samples))) + ", name: input/" +
              u.name + ", mode: offset, value: " +
              Dice::rounded(0.3 * spread(u) * dice.between(-1.0, 1.0)) + "}]"};
}

}  // namespace

std::vector<std::string> typesWithoutGenerator() {
  std::vector<std::string> types;
  for (const std::string& type : controllerNames())
    if (!hasGenerator(type)) types.push_back(type);
  return types;
}

double shippedSampleTime(const std::string& plant) {
  for (const std::string& name : loopNames()) {
    const YAML::Node text = YAML::LoadFile(findLoop(name));
    const YAML::Node type = text["plant"] ? text["plant"]["type"] : YAML::Node();
    const YAML::Node time = text["sampling"] ? text["sampling"]["sample_time_s"] : YAML::Node();
    if (type && time && type.Scalar() == plant) return time.as<double>();
  }
  return 0.0;
}

RandomLoop randomShippedLoop(const std::string& type, std::uint64_t seed) {
  const std::vector<std::string> names = loopsOfType(type);
  require(!names.empty(), "config/loop", "a loop with controller.type " + type);
  Dice dice(seed + 2000000);
  RandomFrame frame;
  Overrides overrides = withoutRecords(names.front());
  const LoopFile shipped = readLoop(names.front(), overrides);
  frame.plant = makePlant(shipped.simulation)->description();
  for (const auto& one : shortened(dice, shipped, frame)) overrides.push_back(one);
  if (dice.chance(0.7))
    overrides.push_back(noiseOf(dice, frame, namesOf(shipped.plant_info.outputs)));
  overrides.emplace_back("seed", std::to_string(dice.whole(0, 99)));
  if (dice.chance(0.5)) overrides.push_back(offsetOf(dice, frame));
  RandomLoop loop;
  loop.seed = seed;
  loop.controller = type;
  loop.plant = shipped.simulation.plant;
  loop.outputs = namesOf(shipped.plant_info.outputs);
  loop.text = readLoop(names.front(), overrides).resolved;
  return loop;
}

}  // namespace fpc
