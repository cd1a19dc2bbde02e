#include "control/targets/params.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "control/read_observer.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/base/yaml_section.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

constexpr int kMostRanks = 100;

/// Half a zone given up counts as one; without two limits, a tenth of the plant's range.
double defaultUnit(const TargetOutput& output, const SignalInfo& about) {
  const double width = output.upper - output.lower;
  if (std::isfinite(width) && width > 0.0) return 0.5 * width;
  const double range = about.upper - about.lower;
  return std::isfinite(range) && range > 0.0 ? 0.1 * range : 1.0;
}

void readOutput(YamlSection& section, const SignalInfo& about, TargetOutput& output) {
  section.interval("zone", output.lower, output.upper);
  section.integer("rank", output.rank, 1, kMostRanks);
  section.boolean("setpoint", output.setpoint);
  output.unit = defaultUnit(output, about);
  section.number("unit", output.unit, kFinitePositive);
  section.number("price", output.price, kFinite);
  section.boolean("integrating", output.integrating);
  section.finish();
}

void readInput(YamlSection& section, TargetInput& input) {
  const double lower = input.lower, upper = input.upper;
  section.interval("range", input.lower, input.upper, {lower, upper});
  section.number("rest", input.rest, {input.lower, input.upper});
  section.number("price", input.price, kFinite);
  section.finish();
}

}  // namespace

void TargetParams::validate(const PlantInfo& plant, const InputLimits& limits) const {
  require(countOf(outputs) == countOf(plant.outputs), "targets.outputs", "one entry per output");
  require(countOf(inputs) == limits.lower.size(), "targets.inputs", "one entry per input");
  require(std::isfinite(band) && band >= 0.0, "targets.band", "a finite number >= 0");
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string field = "targets.outputs." + plant.outputs[i].name;
    require(outputs[i].lower <= outputs[i].upper, field + ".zone",
            "[lower, upper] with lower <= upper");
    require(outputs[i].unit > 0.0, field + ".unit", "a number > 0");
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    require(inputs[i].lower >= limits.lower[k] && inputs[i].upper <= limits.upper[k] &&
                inputs[i].lower <= inputs[i].upper,
            "targets.inputs." + plant.inputs[i].name, "bounds inside the actuator's");
  }
  observer.validate(countOf(plant.outputs));
}

int TargetParams::lastRank() const {
  int last = 1;
  for (const TargetOutput& output : outputs) {
    if (output.hasZone() || output.setpoint) last = std::max(last, output.rank);
  }
  return last;
}

TargetParams readTargetParams(YamlSection& section, const ControllerContext& loop) {
  TargetParams params;
  params.outputs.resize(loop.plant.outputs.size());
  params.inputs.resize(loop.plant.inputs.size());
  YamlSection outputs = section.section("outputs");
  for (std::size_t i = 0; i < params.outputs.size(); ++i) {
    YamlSection output = outputs.section(loop.plant.outputs[i].name);
    readOutput(output, loop.plant.outputs[i], params.outputs[i]);
  }
  outputs.finish();
  YamlSection inputs = section.section("inputs");
  for (std::size_t i = 0; i < params.inputs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    params.inputs[i].lower = loop.limits.lower[k];
    params.inputs[i].upper = loop.limits.upper[k];
    params.inputs[i].rest = kNaN;
    YamlSection input = inputs.section(loop.plant.inputs[i].name);
    readInput(input, params.inputs[i]);
  }
  inputs.finish();
  section.number("band", params.band, kFiniteNotNegative);
  readObserver(section, params.observer, loop, ObserverKey::kAlways);
  return params;
}

}  // namespace fpc
