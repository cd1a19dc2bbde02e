// What a simulation needs to be right before it starts: every field against the plant's
// description.
#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "plant/simulation.hpp"

namespace fpc {
namespace {

using Index = Eigen::Index;

Index count(const std::vector<Quantity>& quantities) {
  return static_cast<Index>(quantities.size());
}

const Quantity& find(const std::vector<Quantity>& quantities, const std::string& name,
                     const std::string& key) {
  const auto found = std::find_if(quantities.begin(), quantities.end(),
                                  [&](const Quantity& q) { return q.name == name; });
  std::vector<std::string> known;
  for (const auto& q : quantities) known.push_back(q.name);
  require(found != quantities.end(), key + ": '" + name + "'", "one of " + join(known));
  return *found;
}

void requireNames(const std::vector<std::string>& names, const std::vector<Quantity>& quantities,
                  const std::string& key) {
  for (auto it = names.begin(); it != names.end(); ++it) {
    find(quantities, *it, key);
    require(std::find(names.begin(), it, *it) == it, key + ": '" + *it + "'",
            "every name only once");
  }
}

bool isInside(double value, const Quantity& q) {
  return std::isfinite(value) && value >= q.lower && value <= q.upper;
}

void requireInside(double value, const Quantity& q, const std::string& key) {
  require(isInside(value, q), key + "." + q.name,
          "a number >= " + exactText(q.lower) + " and <= " + exactText(q.upper) + " [" + q.unit +
              "], got " + exactText(value));
}

void requireInside(const Vector& values, const std::vector<Quantity>& quantities,
                   const std::string& key) {
  require(values.size() == count(quantities), key, std::to_string(quantities.size()) + " numbers");
  for (Index i = 0; i < values.size(); ++i)
    requireInside(values[i], quantities[static_cast<std::size_t>(i)], key);
}

void checkRecord(const SimulationParams& params, const PlantDescription& plant) {
  const Matrix& values = params.disturbance.values;
  if (values.size() == 0) return;
  require(values.rows() == count(plant.disturbances), "disturbance",
          "one row per disturbance of the plant");
  require(values.cols() >= static_cast<Index>(params.samples) + 1, "disturbance",
          "a column for every sample of the run");
  for (Index k = 0; k < values.cols(); ++k)  // words only where they are needed: they take longer
    for (Index i = 0; i < values.rows(); ++i) {
      const Quantity& q = plant.disturbances[static_cast<std::size_t>(i)];
      if (!isInside(values(i, k), q))
        requireInside(values(i, k), q, "disturbance: sample " + std::to_string(k));
    }
}

void checkActuator(const ActuatorParams& actuator, const PlantDescription& plant) {
  actuator.validate(count(plant.inputs));
  requireInside(actuator.limits.lower, plant.inputs, "actuator.input_lower");
  requireInside(actuator.limits.upper, plant.inputs, "actuator.input_upper");
}

/// A valve of the file is stuck where the plant could have it.
void checkStuckValves(const SimulationParams& params, const PlantDescription& plant) {
  for (std::size_t n = 0; n < params.disturbance_commands.size(); ++n) {
    const Command& command = params.disturbance_commands[n].command;
    if (command.mode != CommandMode::kOverride) continue;
    for (std::size_t i = 0; i < std::min(command.name.size(), command.value.size()); ++i)
      for (const Quantity& q : plant.inputs)
        require(command.name[i] != "input/" + q.name ||
                    (command.value[i] >= q.lower && command.value[i] <= q.upper),
                "disturbance.commands[" + std::to_string(n) + "].value",
                "a number >= " + exactText(q.lower) + " and <= " + exactText(q.upper) + " [" +
                    q.unit + "], the range of the plant's input " + q.name + ", got " +
                    exactText(command.value[i]));
  }
}

void checkSensors(SimulationParams& params) {
  const std::size_t n_y = params.outputs.size();
  if (params.output_delay_s.empty()) params.output_delay_s.assign(n_y, 0.0);
  if (params.noise_std.size() == 0) params.noise_std = Vector::Zero(static_cast<Index>(n_y));
  const std::string numbers = std::to_string(n_y) + " numbers";
  require(params.output_delay_s.size() == n_y, "tf.sample_lines", numbers);
  require(params.noise_std.size() == static_cast<Index>(n_y), "noise.std", numbers);
  for (const double std : params.noise_std)
    require(std >= 0.0 && std::isfinite(std), "noise.std", "finite numbers >= 0");
}

}  // namespace

std::vector<Quantity> measurable(const PlantDescription& plant) {
  std::vector<Quantity> all = plant.states;
  all.insert(all.end(), plant.algebraic.begin(), plant.algebraic.end());
  return all;
}

std::unique_ptr<Plant> makePlant(const SimulationParams& params) {
  return params.factory ? params.factory(params.parameters)
                        : makePlant(params.plant, params.parameters);
}

SimulationParams checked(SimulationParams params, const Plant& plant) {
  const PlantDescription& description = plant.description();
  if (params.outputs.empty()) params.outputs = description.outputs;
  requireNames(params.outputs, measurable(description), "plant.outputs");
  requireNames(params.measured_disturbances, description.disturbances,
               "plant.measured_disturbances");
  requireInside(params.initial_state, description.states, "plant.initial_state");
  requireInside(params.disturbance_nominal, description.disturbances, "disturbance.nominal");
  const Index n_d = count(description.disturbances);
  if (params.disturbance_noise_std.size() == 0) params.disturbance_noise_std = Vector::Zero(n_d);
  require(params.disturbance_noise_std.size() == n_d &&
              (params.disturbance_noise_std.array() >= 0.0).all() &&
              params.disturbance_noise_std.allFinite(),
          "disturbance.noise_std", std::to_string(n_d) + " finite numbers >= 0");
  checkActuator(params.actuator, description);
  checkRecord(params, description);
  checkSensors(params);
  checkStuckValves(params, description);
  params.integrator.validate();
  for (const auto& scheduled : params.disturbance_commands)
    require(scheduled.time_h >= 0.0 && scheduled.time_h <= kLatestCommandH,
            "disturbance.commands: time_h", "a number >= 0 and <= 1e6");
  return params;
}

PlantInfo makePlantInfo(const SimulationParams& params, const PlantDescription& description) {
  PlantInfo info;
  info.header = SampleClock(params.sample_time_s, params.start_time_s).header(0, 0);
  info.name = description.name;
  info.frame_id = description.frames.empty() ? description.name : description.frames.front().name;
  info.sample_time_s = params.sample_time_s;
  const std::vector<Quantity> can_be_measured = measurable(description);
  for (const auto& name : params.outputs) {
    const Quantity& q = find(can_be_measured, name, "plant.outputs");
    info.outputs.push_back({q.name, q.unit, q.lower, q.upper});
    const auto frame = description.output_frames.find(name);
    info.output_frames.push_back(frame != description.output_frames.end() ? frame->second
                                                                          : info.frame_id);
  }
  for (std::size_t i = 0; i < description.inputs.size(); ++i) {
    const Quantity& q = description.inputs[i];
    const auto row = static_cast<Index>(i);
    info.inputs.push_back(
        {q.name, q.unit, params.actuator.limits.lower[row], params.actuator.limits.upper[row]});
  }
  for (const auto& name : params.measured_disturbances) {
    const Quantity& q = find(description.disturbances, name, "plant.measured_disturbances");
    info.disturbances.push_back({q.name, q.unit, q.lower, q.upper});
  }
  return info;
}

}  // namespace fpc
