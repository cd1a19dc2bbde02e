#include "config/loop_file.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "config/gone_keys.hpp"
#include "config/plant_sample_model.hpp"
#include "config/plugins.hpp"
#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/model/model_match.hpp"

namespace fpc {
namespace {

constexpr int kIntegrationSteps = 4;  // of a sample, in nmpc

/// A plant that moves by steps of its own would ignore what the section says.
void refuseUnusedIntegrator(YamlSection& root, const LoopFile& loop) {
  const YamlSection plant = root.section("plant");
  if (!plant.has("integrator")) return;
  const auto simulated = makePlant(loop.simulation);
  if (simulated->makeStepper(loop.simulation.sample_time_s))
    plant.fail("integrator", "no such section for " + simulated->description().name +
                                 ", which moves by steps of its own");
}

/// Lets the plant describe itself, so that nodes and process agree to the last bit.
void describePlant(YamlSection& root, LoopFile& loop) {
  if (!loop.external_plant) {
    checked(root, [&] { loop.plant_info = Simulation(loop.simulation).info(); });
    refuseUnusedIntegrator(root, loop);
  }
  PlantInfo& info = loop.plant_info;
  info.sample_time_s = loop.simulation.sample_time_s;
  info.header = SampleClock(info.sample_time_s, loop.simulation.start_time_s).header(0, 0);
}

const std::vector<std::string>& sections() {
  static const std::vector<std::string> names{
      "actuator", "candidate",    "clp",        "controller", "disturbance", "estimator",
      "extends",  "gateway",      "guard",      "loop",       "model",       "noise",
      "plant",    "plausibility", "plugins",    "report",     "sampling",    "sensors",
      "seed",     "setpoint",     "standstill", "targets",    "tf",          "title"};
  return names;
}

/// A misspelt section would otherwise be told as what lacks without it.
void requireKnownSections(const YamlSection& root) {
  for (const std::string& key : root.keys()) {
    if (std::count(sections().begin(), sections().end(), key) > 0) continue;
    const auto near = nearest(key, sections(), 1);
    throw InputError(root.where(key) + ": unknown key" +
                     (near.empty() ? "" : " (" + near.front() + "?)") + "; expected one of " +
                     join(sections()));
  }
}

/// Before anything else: what follows may name plants and controllers of theirs.
void readPlugins(YamlSection& root) {
  std::vector<std::string> plugins;
  root.names("plugins", plugins);
  for (const auto& plugin : plugins) loadPlugin(plugin, root.where("plugins"));
}

/// Nominal values of the measured disturbances.
Vector nominalDisturbances(const LoopFile& loop, const LoopNames& names) {
  Vector nominal(static_cast<Eigen::Index>(names.seen_disturbances.size()));
  for (Eigen::Index i = 0; i < nominal.size(); ++i) {
    const auto& all = names.disturbances;
    const auto at =
        std::find(all.begin(), all.end(), names.seen_disturbances[static_cast<std::size_t>(i)]);
    nominal[i] = loop.simulation.disturbance_nominal[at - all.begin()];
  }
  return nominal;
}

/// Rounding to steps of q adds noise of q / sqrt(12).
void addResolution(const LoopFile& loop, ControllerContext& context) {
  for (const auto& [name, sensor] : loop.simulation.instruments.sensors) {
    const auto names = namesOf(loop.plant_info.outputs);
    const auto at = std::find(names.begin(), names.end(), name) - names.begin();
    if (sensor.resolution == 0.0 || at >= context.noise_std.size()) continue;
    context.quantised = true;
    context.noise_std[at] = std::hypot(context.noise_std[at], sensor.resolution / std::sqrt(12.0));
  }
}

LoopFile readKnownSections(YamlSection& root, const std::string& name) {
  LoopFile loop;
  LoopNames names;
  requireKnownSections(root);
  loop.name = name;
  loop.report.title = name;
  root.text("title", loop.report.title);
  root.seed("seed", loop.simulation.noise_seed);
  loop.disturbance.pattern.seed = loop.simulation.noise_seed;
  readPlugins(root);
  readPlant(root, loop, names);
  readSampling(root, loop);
  readActuator(root, loop, names);
  readNoise(root, loop, names);
  readSensors(root, loop, names);
  readDisturbance(root, loop, names);
  readTf(root, loop, names);
  describePlant(root, loop);
  loop.disturbance_nominal = nominalDisturbances(loop, names);
  readSetpoint(root, loop, names);
  readClp(root, loop, names);
  readController(root, loop);
  readTargets(root, loop);
  readGuard(root, loop, names);
  readEstimator(root, loop);
  readGateway(root, loop);
  readStandstill(root, loop);
  readPlausibility(root, loop);
  readModelSection(root, loop);
  readCandidate(root, loop);
  readExchange(root, loop);
  readReport(root, loop, names);
  root.finish();
  return loop;
}

}  // namespace

const ControllerType& LoopFile::controllerType() const {
  require(controller != nullptr, name + ": controller", "a section controller that was read");
  return controller->type();
}

ControllerContext controllerContext(const LoopFile& loop) {
  const ActuatorParams& actuator = loop.simulation.actuator;
  ControllerContext context{loop.plant_info,
                            actuator.limits,
                            actuator.initial,
                            actuator.fallback,
                            loop.disturbance_nominal,
                            loop.simulation.noise_std,
                            loop.has_clp ? loop.clp.perturbation_steps : 0,
                            nullptr,
                            false,
                            loop.simulation.noise_seed};
  addResolution(loop, context);
  if (!loop.external_plant)
    context.plant_model = [simulation = loop.simulation] {
      return makePlantSampleModel(simulation, kIntegrationSteps);
    };
  return context;
}

TsModel matchToLoop(const TsModel& model, const LoopFile& loop) {
  const SignalUse use = loop.controller->signalUse(controllerContext(loop));
  return matchToPlant(model, loop.plant_info, use.estimated);
}

LoopFile readSections(YamlSection& root, const std::string& name) {
  try {
    return readKnownSections(root, name);
  } catch (const InputError& e) {
    explainGoneKeys(root, e.what());
    throw;
  }
}

LoopFile readLoop(const std::string& name_or_path, const Overrides& overrides) {
  const std::string file = findLoop(name_or_path);
  LoopFile loop =
      parseLoop(resolveLoop(file, overrides), std::filesystem::path(file).stem().string());
  loop.file = file;
  return loop;
}

}  // namespace fpc
