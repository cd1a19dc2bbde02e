#include "runtime/factory.hpp"

#include "config/disturbance_source.hpp"
#include "control/estimating_controller.hpp"
#include "fmbpc/base/input_error.hpp"
#include "runtime/model_use.hpp"
#include "supervision/guard.hpp"
#include "supervision/standstill.hpp"

namespace fpc {
namespace {

/// The law, guarded if it predicts with a model.
std::unique_ptr<Controller> makeGuarded(const LoopFile& loop) {
  const ControllerContext context = controllerContext(loop);
  std::unique_ptr<Controller> law = loop.controller->make(context);
  if (!loop.guard.enabled || !law->needsModel()) return law;
  return std::make_unique<GuardedController>(
      std::move(law), loop.fallback ? loop.fallback->make(context) : nullptr, loop.guard,
      loop.simulation.actuator.limits, loop.plant_info);
}

/// The guarded law, on estimates of what is not measured.
std::unique_ptr<Controller> makeEstimating(const LoopFile& loop) {
  std::unique_ptr<Controller> law = makeGuarded(loop);
  if (loop.estimator.outputs.empty()) return law;
  return std::make_unique<EstimatingController>(std::move(law), loop.estimator, loop.plant_info);
}

/// The law, and around it what watches its sensors if the loop asks for it.
std::unique_ptr<Controller> makeController(const LoopFile& loop) {
  std::unique_ptr<Controller> law = makeEstimating(loop);
  if (loop.standstill.signals.empty()) return law;
  const auto& fallback = loop.standstill_fallback;
  return std::make_unique<StandstillWatch>(
      std::move(law), fallback ? fallback->make(controllerContext(loop)) : nullptr, loop.standstill,
      loop.simulation.actuator.limits, loop.plant_info);
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
  ControllerSession session(makeController(loop), loop.setpoint, actuator.limits, actuator.initial,
                            loop.plant_info, loop.max_pole, loop.plausibility);
  if (loop.has_clp) session.leadsAnOptimizer();
  session.withoutSetpoint(loop.report.without_setpoint);
  if (loop.candidate.loop)
    session.watch(makeCandidate(*loop.candidate.loop, loop.candidate.params));
  return session;
}

CandidateLaw makeCandidate(const LoopFile& other, const CandidateParams& params) {
  CandidateLaw candidate;
  candidate.name = other.name;
  candidate.law = makeController(other);
  candidate.model = other.model;
  candidate.params = params;
  candidate.moved = movedInputs(other);
  if (candidate.law->needsModel()) candidate.law->setModel(other.model);
  return candidate;
}

TargetSession makeTargetSession(const LoopFile& loop) {
  require(loop.targets.enabled, loop.name + ": targets", "a section targets that is enabled");
  return {loop.targets, loop.setpoint, loop.simulation.actuator.limits, loop.plant_info};
}

OptimizerSession makeOptimizerSession(const LoopFile& loop) {
  require(loop.has_clp, loop.name + ": clp", "a section clp that is enabled");
  return {loop.clp, loop.simulation.actuator.limits, loop.plant_info};
}

}  // namespace fpc
