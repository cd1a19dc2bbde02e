// Sections `setpoint`, `controller` and `clp`: what is asked and how the input is chosen.
#include <algorithm>
#include <cmath>

#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "control/clp/params.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

/// Setpoints are asked from the present state on, unless the file says more; an external plant has
/// no such state.
Vector defaultSetpoint(const LoopFile& loop, const LoopNames& names) {
  Vector value = Vector::Constant(countOf(names.outputs), std::nan(""));
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    for (const Quantity& q : names.plant.algebraic)
      if (q.name == names.outputs[i]) value[static_cast<Eigen::Index>(i)] = q.nominal;
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    for (std::size_t s = 0; s < names.plant.states.size(); ++s)
      if (names.plant.states[s].name == names.outputs[i])
        value[static_cast<Eigen::Index>(i)] =
            loop.simulation.initial_state[static_cast<Eigen::Index>(s)];
  return value;
}

void requireInRange(const YamlSection& section, const std::string& key, const Vector& values,
                    const PlantInfo& plant) {
  for (std::size_t i = 0; i < plant.outputs.size(); ++i)
    requireInRange(section, key + "." + plant.outputs[i].name, values[static_cast<Eigen::Index>(i)],
                   plant.outputs[i], "setpoint");
}

SetpointStep readSetpointStep(YamlSection& item, const std::vector<std::string>& outputs) {
  SetpointStep step;
  need(item, "time_h", "a time >= 0");
  item.number("time_h", step.time_h, {0.0, 1e7});
  item.number("ramp_h", step.ramp_h, {0.0, 1e7});
  step.value = Vector::Constant(countOf(outputs), std::nan(""));
  for (Eigen::Index i = 0; i < step.value.size(); ++i)
    item.number(outputs[static_cast<std::size_t>(i)], step.value[i], kFinite);
  item.finish();
  return step;
}

/// Of two setpoints of an output at one time the first would pass for one that was played.
void requireOnce(const YamlSection& item, const std::vector<SetpointStep>& schedule,
                 const std::vector<std::string>& outputs) {
  const SetpointStep& last = schedule.back();
  if (last.ramp_h > 0.0) return;  // the one before is where the ramp begins
  for (auto before = schedule.rbegin() + 1; before != schedule.rend(); ++before) {
    if (before->time_h != last.time_h) return;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (!std::isnan(before->value[k]) && !std::isnan(last.value[k]))
        item.fail(outputs[i], "one setpoint of " + outputs[i] + " at one time");
    }
  }
}

void defaultClp(ClpParams& clp, Eigen::Index n_y, Eigen::Index n_u) {
  clp.weight_perturbation = Vector::Ones(n_u);
  clp.weight_tracking = Vector::Zero(n_y);
  clp.weight_state_output = Vector::Ones(n_y);
  clp.weight_input = Vector::Ones(n_u);
  clp.increment_lower = Vector::Constant(n_u, -kInfinity);
  clp.increment_upper = Vector::Constant(n_u, kInfinity);
  clp.output_lower = Vector::Constant(n_y, -kInfinity);
  clp.output_upper = Vector::Constant(n_y, kInfinity);
}

void readClpParams(YamlSection& section, ClpParams& clp, const LoopNames& names) {
  section.integer("perturbation_steps", clp.perturbation_steps, 1, 1000);
  readOption(section, "cost", clp.cost);
  section.byName("weight_perturbation", clp.weight_perturbation, names.inputs, kFinitePositive);
  section.byName("weight_tracking", clp.weight_tracking, names.outputs, kFiniteNotNegative);
  readOption(section, "bounds", clp.bounds);
  section.byName("increment_lower", clp.increment_lower, names.inputs);
  section.byName("increment_upper", clp.increment_upper, names.inputs);
  section.byName("output_lower", clp.output_lower, names.outputs);
  section.byName("output_upper", clp.output_upper, names.outputs);
  section.number("output_penalty", clp.output_penalty, kFinitePositive);
  YamlSection qp = section.section("qp");
  qp.integer("max_iterations", clp.qp.max_iterations, 1);
  qp.finish();
}

bool isThere(const YamlSection& root, const std::string& name) {
  return root.has(name) && !root.raw(name).IsNull();
}

/// The steady state that the optimizer counts from is that of the outputs which the law steers.
void aimOptimizer(const YamlSection& section, LoopFile& loop) {
  const auto n_y = countOf(loop.plant_info.outputs), n_u = countOf(loop.plant_info.inputs);
  if (n_y != n_u && needsTarget(loop.clp))
    for (const Eigen::Index i : loop.controller->signalUse(controllerContext(loop)).followed)
      loop.clp.target_outputs.push_back(static_cast<int>(i));
  checked(section, [&] { loop.clp.validate(n_y, n_u); });
}

/// Zones become soft limits of the optimizer, unless its section has others; a rank above another
/// one weighs kRankWeight times as much there.
void limitOptimizer(LoopFile& loop) {
  constexpr double kRankWeight = 30.0;
  constexpr int kMostSteps = 4;
  const int last = loop.targets.lastRank();
  loop.clp.output_weight = Vector::Ones(countOf(loop.targets.outputs));
  for (std::size_t i = 0; i < loop.targets.outputs.size(); ++i) {
    const TargetOutput& output = loop.targets.outputs[i];
    const auto k = static_cast<Eigen::Index>(i);
    if (!output.hasZone()) continue;
    double& lower = loop.clp.output_lower[k];
    double& upper = loop.clp.output_upper[k];
    if (!std::isfinite(lower)) lower = output.lower;
    if (!std::isfinite(upper)) upper = output.upper;
    loop.clp.output_weight[k] = std::pow(kRankWeight, std::min(last - output.rank, kMostSteps));
  }
}

}  // namespace

void requireInRange(const YamlSection& section, const std::string& key, double value,
                    const SignalInfo& signal, const std::string& what, const std::string& whose) {
  if (std::isnan(value) || (value >= signal.lower && value <= signal.upper)) return;
  throw InputError(section.where(key) + ": expected a " + what + " of " + signal.name +
                   " >= " + exactText(signal.lower) + " and <= " + exactText(signal.upper) + " [" +
                   signal.unit + "], " + whose + ", got " + exactText(value));
}

void readSetpoint(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("setpoint");
  SetpointParams& params = loop.setpoint;
  const Eigen::Index n_y = countOf(names.outputs);
  params.initial = defaultSetpoint(loop, names);
  params.lower = Vector::Constant(n_y, -kInfinity);
  params.upper = Vector::Constant(n_y, kInfinity);
  params.rate_per_h = Vector::Constant(n_y, kInfinity);
  section.byName("initial", params.initial, names.outputs, kFinite);
  if (!params.initial.allFinite())
    section.fail("initial", "a value for each of " + join(names.outputs));
  if (section.has("initial")) requireInRange(section, "initial", params.initial, loop.plant_info);
  for (auto& item : section.list("schedule")) {
    params.schedule.push_back(readSetpointStep(item, names.outputs));
    for (std::size_t i = 0; i < names.outputs.size(); ++i)
      requireInRange(item, names.outputs[i],
                     params.schedule.back().value[static_cast<Eigen::Index>(i)],
                     loop.plant_info.outputs[i], "setpoint");
    if (params.schedule.size() > 1 &&
        params.schedule.end()[-2].time_h > params.schedule.back().time_h)
      item.fail("time_h", "times that do not decrease");
    requireOnce(item, params.schedule, names.outputs);
  }
  section.byName("lower", params.lower, names.outputs);
  section.byName("upper", params.upper, names.outputs);
  section.byName("rate_per_h", params.rate_per_h, names.outputs, Range{0.0, kInfinity, true});
  for (Eigen::Index i = 0; i < n_y; ++i) {  // what a person asks is clamped likewise
    const SignalInfo& range = loop.plant_info.outputs[static_cast<std::size_t>(i)];
    params.lower[i] = std::max(params.lower[i], range.lower);
    params.upper[i] = std::min(params.upper[i], range.upper);
  }
  const SampleClock clock(loop.simulation.sample_time_s, loop.simulation.start_time_s);
  for (auto& item : section.list("commands")) {
    ScheduledCommand scheduled = readCommand(item, names.outputs);
    const auto output = static_cast<std::size_t>(
        std::find(names.outputs.begin(), names.outputs.end(), scheduled.command.name.front()) -
        names.outputs.begin());
    if (scheduled.command.mode == CommandMode::kOverride)
      requireInRange(item, "value", scheduled.command.value.front(),
                     loop.plant_info.outputs[output], "setpoint");
    scheduled.command.time_ns = clock.timeAt(clock.firstStepAtHours(scheduled.time_h));
    params.commands.push_back(std::move(scheduled.command));
  }
  checked(section, [&] { params.validate(n_y); });
  section.finish();
}

void readClp(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  bool off = false;
  YamlSection section = root.sectionOrOff("clp", off);
  loop.has_clp = isThere(root, "clp") && !off;
  const Eigen::Index n_y = countOf(names.outputs), n_u = countOf(names.inputs);
  defaultClp(loop.clp, n_y, n_u);
  readClpParams(section, loop.clp, names);
  section.finish();
}

void readController(YamlSection& root, LoopFile& loop) {
  YamlSection section = root.section("controller");
  loop.controller = readController(section, controllerContext(loop));
  if (loop.has_clp) aimOptimizer(root.section("clp"), loop);
  if (!loop.has_clp || loop.controllerType().predicts) return;
  std::vector<std::string> predicting;
  for (const auto& name : controllerNames())
    if (controllerType(name).predicts) predicting.push_back(name);
  section.fail("type", "a controller that predicts (" + join(predicting) +
                           ") for clp; clp: false takes the optimizer out");
}

std::shared_ptr<const ControllerConfig> readFallback(YamlSection& section, const LoopFile& loop) {
  bool off = false;
  YamlSection fallback = section.sectionOrOff("fallback", off);
  if (!section.has("fallback") || off) return nullptr;
  std::shared_ptr<const ControllerConfig> read = readController(fallback, controllerContext(loop));
  if (read->type().open_loop) fallback.fail("type", "a controller that follows setpoints");
  return read;
}

void readTargets(YamlSection& root, LoopFile& loop) {
  bool off = false;
  YamlSection section = root.sectionOrOff("targets", off);
  const bool enabled = isThere(root, "targets") && !off;
  const ControllerContext context = controllerContext(loop);
  loop.targets = readTargetParams(section, context);
  loop.targets.enabled = enabled;
  section.finish();
  if (!enabled) return;
  if (loop.controllerType().open_loop)
    root.fail("targets", "false, or a controller that follows setpoints");
  checked(section, [&] { loop.targets.validate(loop.plant_info, context.limits); });
  limitOptimizer(loop);
}

}  // namespace fpc
