// Sections `disturbance`, `actuator`, `noise`: what acts on the plant and how its ends behave.
#include <algorithm>

#include "base/yaml_node.hpp"
#include "config/range.hpp"
#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

/// The plant's usual values and ranges of its inputs; for an external plant the declared ranges.
void defaultActuator(const LoopFile& loop, const LoopNames& names, ActuatorParams& actuator) {
  const Eigen::Index n_u = countOf(names.inputs);
  actuator.limits = {Vector(n_u), Vector(n_u), Vector::Constant(n_u, kInfinity)};
  actuator.initial = Vector::Zero(n_u);
  for (Eigen::Index i = 0; i < n_u; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const bool external = loop.external_plant;
    actuator.limits.lower[i] =
        external ? loop.plant_info.inputs[k].lower : names.plant.inputs[k].lower;
    actuator.limits.upper[i] =
        external ? loop.plant_info.inputs[k].upper : names.plant.inputs[k].upper;
    if (!external) actuator.initial[i] = names.plant.inputs[k].nominal;
  }
}

void readPattern(YamlSection& section, PatternParams& params,
                 const std::vector<std::string>& names) {
  YamlSection channels = section.section("channels");
  for (const auto& name : names) {
    if (!channels.has(name)) continue;
    YamlSection channel = channels.section(name);
    PatternChannel value;
    value.name = name;
    for (const char* key : {"shape", "range", "mean"}) need(channel, key, "a value");
    channel.oneOf("shape", value.shape, {"flow", "load"});
    readRange(channel, "range", value.lower, value.upper, kFinite);
    channel.number("mean", value.mean, {value.lower, value.upper, true});
    channel.finish();
    params.channels.push_back(std::move(value));
  }
  for (const auto& name : names) channels.markRead(name);
  channels.finish();
  section.finish();
}

/// The plant's own noise of these signals.
Vector usualNoise(const std::vector<std::string>& signals, const LoopNames& names) {
  Vector std = Vector::Zero(countOf(signals));
  for (std::size_t i = 0; i < signals.size(); ++i) {
    const auto known = names.plant.noise_std.find(signals[i]);
    if (known != names.plant.noise_std.end()) std[static_cast<Eigen::Index>(i)] = known->second;
  }
  return std;
}

/// Names that a disturbance command may use: disturbances, stuck valves, sensor faults.
std::vector<std::string> commandNames(const LoopNames& names) {
  std::vector<std::string> all = names.disturbances;
  for (const auto& name : names.inputs) all.push_back("input/" + name);
  for (const auto& name : names.outputs) all.push_back("output/" + name);
  return all;
}

}  // namespace

void readMode(YamlSection& item, Command& command) {
  readOption(item, "mode", command.mode,
             {{"override", CommandMode::kOverride},
              {"offset", CommandMode::kOffset},
              {"release", CommandMode::kRelease}});
}

ScheduledCommand readCommand(YamlSection& item, const std::vector<std::string>& names) {
  ScheduledCommand scheduled;
  double value = 0.0;
  need(item, "time_h", "a time >= 0");
  item.number("time_h", scheduled.time_h, {0.0, kLatestCommandH});
  scheduled.command.name = {names[static_cast<std::size_t>(indexByName(item, "name", names))]};
  readMode(item, scheduled.command);
  if (scheduled.command.mode != CommandMode::kRelease) need(item, "value", "a number");
  item.number("value", value, kFinite);
  scheduled.command.value = {value};
  item.finish();
  return scheduled;
}

void readActuator(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("actuator");
  ActuatorParams& actuator = loop.simulation.actuator;
  defaultActuator(loop, names, actuator);
  section.byName("input_lower", actuator.limits.lower, names.inputs);
  section.byName("input_upper", actuator.limits.upper, names.inputs);
  section.byName("move_upper", actuator.limits.move, names.inputs, Range{0.0, kInfinity, true});
  section.byName("initial", actuator.initial, names.inputs, kFinite);
  actuator.fallback = actuator.initial;
  section.byName("fallback", actuator.fallback, names.inputs, kFinite);
  section.integer("hold_samples", actuator.hold_samples, -1);
  readLag(section, actuator, names.inputs);
  checked(section, [&] { actuator.validate(countOf(names.inputs)); });
  section.finish();
}

void readNoise(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("noise");
  loop.simulation.noise_std = usualNoise(names.outputs, names);
  section.byName("std", loop.simulation.noise_std, names.outputs, kFiniteNotNegative);
  section.finish();
}

void readDisturbance(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("disturbance");
  DisturbanceParams& params = loop.disturbance;
  Vector& nominal = loop.simulation.disturbance_nominal;
  nominal = Vector::Zero(countOf(names.disturbances));
  for (std::size_t i = 0; i < names.plant.disturbances.size(); ++i)
    nominal[static_cast<Eigen::Index>(i)] = names.plant.disturbances[i].nominal;
  section.byName("nominal", nominal, names.disturbances, kFinite);
  loop.simulation.disturbance_noise_std = usualNoise(names.disturbances, names);
  section.byName("noise_std", loop.simulation.disturbance_noise_std, names.disturbances,
                 kFiniteNotNegative);
  readOption(section, "source", params.source);
  for (const char* unused : {"csv", "pattern"})  // forgotten, not overridden
    if (!section.has("source") && section.has(unused) && section.raw(unused).size() > 0)
      section.fail(unused, std::string("disturbance.source: ") + unused +
                               " with it (constant leaves it out)");
  YamlSection pattern = section.section("pattern");
  readPattern(pattern, params.pattern, names.disturbances);
  if (params.source == DisturbanceSource::kPattern && params.pattern.channels.empty())
    pattern.fail("channels", "at least one disturbance out of " + join(names.disturbances));
  YamlSection csv = section.section("csv");
  readCsvSection(csv, params.csv, names.disturbances);
  if (params.source == DisturbanceSource::kCsv) {
    need(csv, "file", "the name of a CSV file");
    need(csv, "time_column", "the name of a column");
    if (params.csv.channels.empty())
      csv.fail("channels", "at least one disturbance out of " + join(names.disturbances));
  }
  for (auto& item : section.list("commands"))
    loop.simulation.disturbance_commands.push_back(readCommand(item, commandNames(names)));
  section.finish();
}

}  // namespace fpc
