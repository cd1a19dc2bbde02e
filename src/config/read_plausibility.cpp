// Section `plausibility`: what a measurement may be, signal by signal.
#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace {

constexpr double kJumpOfRange = 0.5;
constexpr int kBridged = 3;
constexpr double kMargin = 0.1;  // of the plant's range, beside it

/// What is known of the instrument: where its scale ends.
void describeInstrument(const LoopFile& loop, const SignalInfo& signal, SignalPlausibility& asked) {
  asked.scale_lower = signal.lower;
  asked.scale_upper = signal.upper;
  const auto& sensors = loop.simulation.instruments.sensors;
  const auto found = sensors.find(signal.name);
  if (found == sensors.end()) return;
  const SensorParams& sensor = found->second;
  asked.scale_lower = std::max(asked.scale_lower, sensor.lower);
  asked.scale_upper = std::min(asked.scale_upper, sensor.upper);
}

/// The plant's range, wider by a part of itself; an endless one asks nothing.
SignalPlausibility defaultsOf(const SignalInfo& signal, bool is_output) {
  SignalPlausibility asked;
  asked.repeated = is_output;  // records of disturbances are often rounded
  const double range = signal.upper - signal.lower;
  if (!std::isfinite(range)) return asked;
  asked.lower = signal.lower - kMargin * range;
  asked.upper = signal.upper + kMargin * range;
  if (is_output && range > 0.0) asked.jump = kJumpOfRange * range;
  return asked;
}

void readSignal(YamlSection& section, bool is_output, SignalPlausibility& asked) {
  section.interval("range", asked.lower, asked.upper, {});
  section.number("rate_per_h", asked.rate_per_h, {0.0, kInfinity, true});
  section.number("jump", asked.jump, {0.0, kInfinity, true});
  section.boolean("frozen", asked.frozen);
  if (section.has("frozen")) asked.repeated = is_output && asked.frozen;
  readOption(section, "substitute", asked.substitute);
  section.finish();
}

void readSignals(YamlSection& signals, const LoopFile& loop, const std::vector<SignalInfo>& infos,
                 bool is_output, std::vector<SignalPlausibility>& list) {
  for (const SignalInfo& info : infos) {
    SignalPlausibility asked = defaultsOf(info, is_output);
    describeInstrument(loop, info, asked);
    const auto& watched = loop.standstill.signals;  // by a section made for it
    asked.frozen = std::none_of(watched.begin(), watched.end(),
                                [&](const WatchedSignal& w) { return w.name == info.name; });
    YamlSection section = signals.section(info.name);
    readSignal(section, is_output, asked);
    list.push_back(asked);
  }
}

}  // namespace

void readPlausibility(YamlSection& root, LoopFile& loop) {
  bool off = false;
  YamlSection section = root.sectionOrOff("plausibility", off);
  PlausibilityParams& params = loop.plausibility;
  const PlantInfo& plant = loop.plant_info;
  const ActuatorParams& actuator = loop.simulation.actuator;
  params.enabled = !off;
  params.gain_sign = true;
  params.bridge_samples = off ? 0 : kBridged;
  params.fallback = actuator.fallback;
  params.range_falls = root.section("actuator").has("fallback");  // an initial input is none
  params.hold_samples = actuator.hold_samples;
  params.needs = loop.controller->signalUse(controllerContext(loop)).needed;
  for (const auto* fallback : {&loop.fallback, &loop.standstill_fallback}) {
    if (!*fallback) continue;
    const std::vector<bool> needed = (*fallback)->signalUse(controllerContext(loop)).needed;
    for (std::size_t i = 0; i < needed.size(); ++i) params.needs[i] = params.needs[i] || needed[i];
  }
  for (const Eigen::Index hidden : loop.estimator.outputs)
    params.needs[static_cast<std::size_t>(hidden)] = false;  // estimated, whatever is measured
  section.integer("reaction_samples", params.reaction_samples, 0, 100000);
  loop.stuck.hold = loop.gateway.enabled();
  readOption(section, "stuck", loop.stuck.hold, {{"say", false}, {"hold", true}});
  YamlSection signals = section.section("signals");
  readSignals(signals, loop, plant.outputs, true, params.outputs);
  readSignals(signals, loop, plant.disturbances, false, params.disturbances);
  signals.finish();
  checked(section, [&] {
    params.validate(plant.outputs.size(), plant.disturbances.size(),
                    static_cast<Eigen::Index>(plant.inputs.size()));
  });
  section.finish();
}

}  // namespace fpc
