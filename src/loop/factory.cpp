#include "fmbpc/loop/factory.hpp"

#include "config/plant_sample_model.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/disturbance_source.hpp"

namespace fpc {
namespace {

std::unique_ptr<Controller> makeController(const LoopFile& loop) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  if (loop.controller == "pi")
    return std::make_unique<PiController>(loop.pi, limits, loop.plant_info);
  if (loop.controller == "excitation")
    return std::make_unique<ExcitationController>(
        loop.excitation, limits, loop.simulation.actuator.initial, loop.plant_info);
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

}  // namespace

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
