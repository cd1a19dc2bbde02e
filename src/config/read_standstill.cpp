// Section `standstill`: sensors that stand still.

#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "config/read_safety.hpp"
#include "fmbpc/base/signals.hpp"

namespace fpc {
namespace {

using Eigen::Index;

struct SignalNames {
  std::vector<std::string> outputs, disturbances;
};

void readWatched(YamlSection& section, const std::vector<std::string>& names, bool outputs,
                 std::vector<WatchedSignal>& signals) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    section.markRead(names[i]);
    if (!section.has(names[i])) continue;
    WatchedSignal signal{names[i], outputs, static_cast<Index>(i), 0.0};
    section.number(names[i], signal.least_change, kFinitePositive);
    signals.push_back(signal);
  }
}

/// Variance of the noise of what the exchange sees of an instrument: less in a mean over the
/// sample.
double varianceOf(const LoopFile& loop, const std::string& name) {
  const InstrumentParams& instruments = loop.simulation.instruments;
  const auto found = instruments.sensors.find(name);
  if (found == instruments.sensors.end()) return 0.0;
  const SensorParams& sensor = found->second;
  const double between_s = std::max(instruments.step_s, sensor.interval_s);
  const double share = std::min(1.0, between_s / loop.plant_info.sample_time_s);
  return sensor.noise_std * sensor.noise_std * (sensor.average ? share : 1.0);
}

/// Noise of all measured signals, outputs first, as the loop file has it elsewhere.
Vector declaredNoise(const LoopFile& loop, const std::vector<std::string>& measured) {
  Vector std = Vector::Zero(static_cast<Index>(measured.size()));
  const Vector& over = loop.simulation.noise_std;
  for (Index i = 0; i < std.size(); ++i) {
    const double more = i < over.size() ? over[i] : 0.0;
    std[i] = std::sqrt(varianceOf(loop, measured[static_cast<std::size_t>(i)]) + more * more);
  }
  return std;
}

void setNoise(const LoopFile& loop, const SignalNames& names, std::vector<WatchedSignal>& signals) {
  std::vector<std::string> measured = names.outputs;
  measured.insert(measured.end(), names.disturbances.begin(), names.disturbances.end());
  const Vector std = declaredNoise(loop, measured);
  const auto n_y = static_cast<Index>(names.outputs.size());
  for (WatchedSignal& signal : signals)
    signal.noise_std = std[signal.is_output ? signal.place : n_y + signal.place];
}

/// It sees what is measured, beside a law that sees estimates.
void readOwnFallback(YamlSection& section, LoopFile& loop, const PlantInfo& plant) {
  bool off = false;
  YamlSection fallback = section.sectionOrOff("fallback", off);
  if (section.has("fallback") && !off && !fallback.has("type"))
    fallback.fail("type",
                  "a controller; for inputs that are set by themselves: type: pi, kp: 0, bias");
  loop.standstill_fallback = readFallback(section, loop);
  if (!loop.standstill_fallback) return;
  if (loop.standstill_fallback->type().needs_model)
    fallback.fail("type", "a controller without a model");
  for (const Index followed : loop.standstill_fallback->signalUse(controllerContext(loop)).followed)
    for (const Index hidden : loop.estimator.outputs)
      if (followed == hidden)
        section.fail("fallback", "a controller of measured outputs, not of " +
                                     plant.outputs[static_cast<std::size_t>(hidden)].name);
}

}  // namespace

void readStandstill(YamlSection& root, LoopFile& loop) {
  bool off = false;
  YamlSection section = root.sectionOrOff("standstill", off);
  const PlantInfo& plant = loop.plant_info;
  const SignalNames names{namesOf(plant.outputs), namesOf(plant.disturbances)};
  StandstillParams& params = loop.standstill;
  double window_h = 6.0;
  section.number("window_h", window_h, kFinitePositive);
  double noise_window_h = 4.0 * window_h;
  section.number("noise_window_h", noise_window_h, kFinitePositive);
  params.window_samples =
      std::max(2, static_cast<int>(std::lround(window_h * 3600.0 / plant.sample_time_s)));
  params.noise_window_samples =
      std::max(8, static_cast<int>(std::lround(noise_window_h * 3600.0 / plant.sample_time_s)));
  YamlSection signals = section.section("signals");
  readWatched(signals, names.outputs, true, params.signals);
  readWatched(signals, names.disturbances, false, params.signals);
  signals.finish();
  setNoise(loop, names, params.signals);
  params.usual = loop.disturbance_nominal;
  params.fallback = loop.simulation.actuator.initial;
  readOwnFallback(section, loop, plant);
  section.finish();
}

}  // namespace fpc
