// Section `sensors` and key `actuator.lag`: instruments and drives that follow late.
#include <cmath>
#include <optional>

#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"

namespace fpc {
namespace {

/// A benchmark class; what else the section says goes over it.
void readClass(YamlSection& section, SensorParams& params) {
  std::optional<SensorClass> kind;
  section.interval("range", params.lower, params.upper, {});
  readOption(section, "class", kind,
             {{"none", std::nullopt},
              {"A", SensorClass::kA},
              {"B0", SensorClass::kB0},
              {"B1", SensorClass::kB1},
              {"C0", SensorClass::kC0},
              {"C1", SensorClass::kC1},
              {"D", SensorClass::kD}});
  if (kind) params = sensorOfClass(*kind, params.lower, params.upper);
}

SensorParams readSensor(YamlSection& section) {
  SensorParams params;
  readClass(section, params);
  double t90_s = params.lags > 0 ? params.lag_s * lagsToNinety(params.lags) : 0.0;
  section.number("t90_s", t90_s, kFiniteNotNegative);
  if (section.has("t90_s") && params.lags == 0) params.lags = 1;
  if (section.has("t90_s")) params.lag_s = t90_s / lagsToNinety(params.lags);
  if (params.lag_s == 0.0) params.lags = 0;
  section.number("delay_s", params.delay_s, kFiniteNotNegative);
  section.number("interval_s", params.interval_s, kFiniteNotNegative);
  section.number("noise_std", params.noise_std, kFiniteNotNegative);
  section.number("resolution", params.resolution, kFiniteNotNegative);
  section.boolean("average", params.average);
  section.number("lost", params.lost, {0.0, 1.0});
  section.interval("stuck_h", params.stuck_from_h, params.stuck_to_h, kFiniteNotNegative,
                   "[from, to]");
  checked(section, [&] { params.validate(); });
  section.finish();
  return params;
}

}  // namespace

void readSensors(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("sensors");
  InstrumentParams& params = loop.simulation.instruments;
  params.seed = loop.simulation.noise_seed;
  section.number("step_s", params.step_s, kFinitePositive);
  for (const auto* group : {&names.outputs, &names.seen_disturbances})
    for (const auto& name : *group) {
      section.markRead(name);
      if (!section.has(name)) continue;
      YamlSection sensor = section.section(name);
      params.sensors[name] = readSensor(sensor);
    }
  section.finish();
}

void readLag(YamlSection& actuator, ActuatorParams& params,
             const std::vector<std::string>& inputs) {
  YamlSection section = actuator.section("lag");
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    section.markRead(inputs[i]);
    if (!section.has(inputs[i])) continue;
    params.drives.resize(inputs.size());
    YamlSection lag = section.section(inputs[i]);
    if (!lag.has("backlash") && !lag.has("stiction")) need(lag, "t90_s", "a time >= 0");
    lag.number("t90_s", params.drives[i].t90_s, kFiniteNotNegative);
    lag.number("backlash", params.drives[i].backlash, kFiniteNotNegative);
    lag.number("stiction", params.drives[i].stiction, kFiniteNotNegative);
    lag.integer("order", params.drives[i].order, 1, 20);
    lag.finish();
  }
  section.finish();
}

}  // namespace fpc
