#include "fmbpc/loop/factory.hpp"

#include "fmbpc/base/input_error.hpp"
#include "loop/plant_sample_model.hpp"

namespace fpc {
namespace {

std::vector<std::string> disturbanceNames(const LoopFile& loop) {
  std::vector<std::string> names;
  const auto plant = makePlant(loop.simulation);
  for (const auto& quantity : plant->description().disturbances) names.push_back(quantity.name);
  return names;
}

std::unique_ptr<Controller> makeController(const LoopFile& loop) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  if (loop.controller == "pi")
    return std::make_unique<PiController>(loop.pi, limits, loop.plant_info);
  if (loop.controller == "excitation")
    return std::make_unique<ExcitationController>(loop.excitation, limits,
                                                  loop.simulation.actuator.initial,
                                                  loop.plant_info);
  if (loop.controller == "fuzzy_optimal")
    return std::make_unique<FuzzyOptimalLaw>(loop.fuzzy_optimal, limits, loop.plant_info);
  if (loop.controller == "hybrid_mpc")
    return std::make_unique<HybridMpc>(loop.hybrid, limits, loop.plant_info);
  if (loop.controller == "nmpc")
    return std::make_unique<Nmpc>(
        loop.nmpc, limits, loop.plant_info,
        makePlantSampleModel(loop.simulation, loop.nmpc.integration_steps));
  if (loop.controller == "swarm_mpc")
    return std::make_unique<SwarmMpc>(loop.swarm_mpc, limits, loop.plant_info);
  if (loop.controller == "adaptive_pi")
    return std::make_unique<AdaptivePi>(loop.adaptive_pi, limits, loop.plant_info);
  return std::make_unique<FmbpcLaw>(loop.fmbpc, limits, loop.plant_info);
}

void requireSimulated(const LoopFile& loop) {
  require(!loop.external_plant, loop.name + ": plant.type",
          "a plant that can be simulated; an external one runs over topics only");
}

}  // namespace

DisturbanceRecord makeDisturbance(const LoopFile& loop) {
  requireSimulated(loop);
  const SimulationParams& sim = loop.simulation;
  const DisturbanceParams& params = loop.disturbance;
  if (params.source == "constant") return {};
  require(
      sim.samples > 0, loop.name + ": sampling.duration_h",
      "a time > 0 with disturbance.source " + params.source + " (an endless run needs constant)");
  const auto names = disturbanceNames(loop);
  if (params.source == "pattern")
    return makePattern(params.pattern, names, sim.disturbance_nominal, sim.sample_time_s,
                       sim.samples);
  return readDisturbances(params.csv, names, sim.disturbance_nominal, sim.sample_time_s,
                          sim.samples);
}

Simulation makeSimulation(const LoopFile& loop) {
  requireSimulated(loop);
  SimulationParams params = loop.simulation;
  params.disturbance = makeDisturbance(loop);
  return Simulation(std::move(params));
}

ControllerSession makeControllerSession(const LoopFile& loop) {
  const ActuatorParams& actuator = loop.simulation.actuator;
  return {makeController(loop), loop.setpoint,   actuator.limits,
          actuator.initial,     loop.plant_info, loop.max_pole};
}

OptimizerSession makeOptimizerSession(const LoopFile& loop) {
  require(loop.has_clp, loop.name + ": clp", "a section clp that is enabled");
  return {loop.clp, loop.simulation.actuator.limits, loop.plant_info};
}

}  // namespace fpc
