// Sections `plant` and `sampling`: what is controlled, and when.
#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "config/signal_names.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

constexpr char kExternal[] = "external";

Range rangeOf(const Quantity& quantity) {
  return {std::max(quantity.lower, -kLargest), std::min(quantity.upper, kLargest)};
}

void readIntegrator(YamlSection& plant, IntegratorParams& params) {
  YamlSection section = plant.section("integrator");
  section.number("relative_tolerance", params.relative_tolerance, kFinitePositive);
  section.number("absolute_tolerance", params.absolute_tolerance, kFinitePositive);
  section.integer("max_steps", params.max_steps, 1);
  readOption(section, "method", params.method);
  checked(section, [&] { params.validate(); });
  section.finish();
}

void readParameters(YamlSection& plant, const PlantDescription& description,
                    PlantParameters& parameters) {
  YamlSection section = plant.section("parameters");
  for (const auto& quantity : description.parameters) {
    double value = quantity.nominal;
    section.number(quantity.name, value, rangeOf(quantity));
    if (section.has(quantity.name)) parameters[quantity.name] = value;
  }
  section.finish();
}

void readInitialState(YamlSection& plant, const PlantDescription& description, Vector& state) {
  YamlSection section = plant.section("initial_state");
  state.resize(static_cast<Eigen::Index>(description.states.size()));
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const Quantity& quantity = description.states[static_cast<std::size_t>(i)];
    state[i] = quantity.nominal;
    section.number(quantity.name, state[i], rangeOf(quantity));
  }
  section.finish();
}

void readSimulated(YamlSection& plant, LoopFile& loop, LoopNames& names) {
  SimulationParams& sim = loop.simulation;
  sim.factory = plantFactory(sim.plant, plant);
  names.plant = makePlant(sim)->description();
  readParameters(plant, names.plant, sim.parameters);
  readInitialState(plant, names.plant, sim.initial_state);
  names.inputs = namesOf(names.plant.inputs);
  names.disturbances = namesOf(names.plant.disturbances);
  sim.outputs = names.plant.outputs;
  plant.subset("outputs", sim.outputs, namesOf(measurable(names.plant)));
  if (sim.outputs.empty()) plant.fail("outputs", "at least one name");
  for (const auto& name : names.disturbances)
    if (std::count(names.plant.hidden_disturbances.begin(), names.plant.hidden_disturbances.end(),
                   name) == 0)
      sim.measured_disturbances.push_back(name);
  plant.subset("measured_disturbances", sim.measured_disturbances, names.disturbances);
  names.outputs = sim.outputs;
  for (const auto& name : names.disturbances)  // PlantInfo keeps the plant's order
    if (std::count(sim.measured_disturbances.begin(), sim.measured_disturbances.end(), name) > 0)
      names.seen_disturbances.push_back(name);
  sim.measured_disturbances = names.seen_disturbances;
  readIntegrator(plant, sim.integrator);
}

std::vector<SignalInfo> readSignals(YamlSection& plant, const std::string& key,
                                    std::vector<std::string>& names) {
  std::vector<SignalInfo> signals;
  for (auto& item : plant.list(key)) {
    SignalInfo signal{"", "", -kInfinity, kInfinity};
    need(item, "name", "a name");
    item.text("name", signal.name);
    item.text("unit", signal.unit);
    item.number("lower", signal.lower, {});
    item.number("upper", signal.upper, {});
    if (!(signal.lower <= signal.upper)) item.fail("upper", "a number >= lower");
    if (std::count(names.begin(), names.end(), signal.name) > 0)
      item.fail("name", "every name only once");
    item.finish();
    names.push_back(signal.name);
    signals.push_back(std::move(signal));
  }
  return signals;
}

void readExternal(YamlSection& plant, LoopFile& loop, LoopNames& names) {
  PlantInfo& info = loop.plant_info;
  loop.external_plant = true;
  need(plant, "name", "a name");
  plant.text("name", info.name);
  info.frame_id = info.name;
  info.outputs = readSignals(plant, "outputs", names.outputs);
  info.inputs = readSignals(plant, "inputs", names.inputs);
  info.disturbances = readSignals(plant, "disturbances", names.disturbances);
  names.seen_disturbances = names.disturbances;
  loop.simulation.outputs = names.outputs;
  loop.simulation.measured_disturbances = names.disturbances;
  info.output_frames.assign(info.outputs.size(), info.frame_id);
  if (info.outputs.empty()) plant.fail("outputs", "at least one output");
  if (info.inputs.empty()) plant.fail("inputs", "at least one input");
}

}  // namespace

void readPlant(YamlSection& root, LoopFile& loop, LoopNames& names) {
  YamlSection plant = root.section("plant");
  std::vector<std::string> types;
  for (const auto& entry : plantTypes()) types.push_back(entry.first);
  types.emplace_back(kExternal);
  need(plant, "type", "one of " + join(types));
  plant.oneOf("type", loop.simulation.plant, types);
  if (loop.simulation.plant == kExternal) {
    readExternal(plant, loop, names);
  } else {
    readSimulated(plant, loop, names);
  }
  requireSignalNames(plant, loop, names);
  plant.finish();
}

void readSampling(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("sampling");
  SimulationParams& sim = loop.simulation;
  double duration_h = 0.0;
  need(section, "sample_time_s", "a time > 0");
  need(section, "duration_h", "a time >= 0; 0 is endless");
  section.number("sample_time_s", sim.sample_time_s, {1e-9, 1e9});
  section.number("duration_h", duration_h, {0.0, 1e7});
  const double samples = duration_h * 3600.0 / sim.sample_time_s;
  if (std::abs(samples - std::round(samples)) > 1e-6 * std::max(1.0, samples))
    section.fail("duration_h",
                 "a whole number of samples of " + exactText(sim.sample_time_s) + " s");
  if (samples > 1e9) section.fail("duration_h", "at most 1e9 samples");
  sim.samples = static_cast<std::uint32_t>(std::llround(samples));
  section.finish();
}

}  // namespace fpc
