// Sections `setpoint`, `controller` and `clp`: what is asked and how the input is chosen.
#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"

namespace fpc {
namespace {

Eigen::Index count(const std::vector<std::string>& names) {
  return static_cast<Eigen::Index>(names.size());
}

/// Setpoints are asked from the present state on, unless the file says more; an external plant has
/// no such state.
Vector defaultSetpoint(const LoopFile& loop, const LoopNames& names) {
  Vector value = Vector::Constant(count(names.outputs), std::nan(""));
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    for (std::size_t s = 0; s < names.plant.states.size(); ++s)
      if (names.plant.states[s].name == names.outputs[i])
        value[static_cast<Eigen::Index>(i)] =
            loop.simulation.initial_state[static_cast<Eigen::Index>(s)];
  return value;
}

/// A setpoint that the plant can never reach is a mistake of unit or digits.
void requireInRange(const YamlSection& section, const std::string& key, double value,
                    const SignalInfo& output) {
  if (std::isnan(value) || (value >= output.lower && value <= output.upper)) return;
  throw InputError(section.where(key) + ": expected a setpoint of " + output.name + " >= " +
                   exactText(output.lower) + " and <= " + exactText(output.upper) + " [" +
                   output.unit + "], the range of the plant, got " + exactText(value));
}

void requireInRange(const YamlSection& section, const std::string& key, const Vector& values,
                    const PlantInfo& plant) {
  for (std::size_t i = 0; i < plant.outputs.size(); ++i)
    requireInRange(section, key, values[static_cast<Eigen::Index>(i)], plant.outputs[i]);
}

SetpointStep readSetpointStep(YamlSection& item, const std::vector<std::string>& outputs) {
  SetpointStep step;
  need(item, "time_h", "a time >= 0");
  item.number("time_h", step.time_h, {0.0, 1e7});
  item.number("ramp_h", step.ramp_h, {0.0, 1e7});
  step.value = Vector::Constant(count(outputs), std::nan(""));
  for (Eigen::Index i = 0; i < step.value.size(); ++i)
    item.number(outputs[static_cast<std::size_t>(i)], step.value[i], kFinite);
  item.finish();
  return step;
}

void readFmbpc(YamlSection& section, LoopFile& loop, const LoopNames& names) {
  FmbpcParams& params = loop.fmbpc;
  const Eigen::Index n_y = count(names.outputs), n_u = count(names.inputs);
  params.reference_pole = Vector::Constant(n_y, 0.9);
  params.weight_output = Vector::Ones(n_y);
  params.weight_move = Vector::Zero(n_u);
  params.disturbance_nominal = nominalDisturbances(loop, names);
  section.oneOf("law", params.law, {"published", "general", "iterated"});
  section.integer("coincidence_steps", params.coincidence_steps, 1, 100000);
  section.byName("reference_pole", params.reference_pole, names.outputs, {0.0, 1.0});
  section.boolean("preview", params.preview);
  section.byName("weight_output", params.weight_output, names.outputs, kFiniteNotNegative);
  section.byName("weight_move", params.weight_move, names.inputs, kFiniteNotNegative);
  section.integer("horizon_steps", params.horizon_steps, 1, 10000);
  section.integer("iterations", params.iterations, 1, 1000);
  double period_h = 0.0;
  section.number("forecast_period_h", period_h, {0.0, 1e4});
  params.forecast_period_steps =
      static_cast<int>(std::lround(period_h * 3600.0 / loop.simulation.sample_time_s));
  section.number("forecast_pole", params.forecast_pole, {0.0, 1.0});
  section.oneOf("realisation", params.realisation, {"parallel", "realigned", "literal"});
  section.integer("delay_steps", params.delay_steps, 0, 1000);
  section.integer("reference_lead_steps", params.reference_lead_steps, 0, 100000);
  section.oneOf("antecedent", params.antecedent, {"model", "measured"});
  section.number("offset_gain", params.offset_gain, {0.0, 1.0});
  section.boolean("disturbance_feedforward", params.disturbance_feedforward);
  section.byName("disturbance_nominal", params.disturbance_nominal, names.seen_disturbances,
                 kFinite);
  section.number("transfer_decay", params.transfer_decay, {0.0, 1.0});
  readPredictionSteps(section, loop, params.prediction_steps);
  checked(section, [&] { params.validate(n_y, n_u); });
}

std::vector<GainPoint> readSchedule(YamlSection& section) {
  std::vector<GainPoint> points;
  for (auto& item : section.list("gain_schedule")) {
    for (const char* key : {"output", "gain"}) need(item, key, "a number");
    GainPoint point;
    item.number("output", point.output, kFinite);
    item.number("gain", point.gain, kFinitePositive);
    item.finish();
    points.push_back(point);
  }
  return points;
}

void readPi(YamlSection& section, LoopFile& loop, const LoopNames& names) {
  if (section.has("reference_pole")) {
    loop.pi.reference_pole = Vector::Constant(count(names.outputs), 0.9);
    section.byName("reference_pole", loop.pi.reference_pole, names.outputs, {0.0, 1.0});
  }
  need(section, "loops", "a list of loops");
  for (auto& item : section.list("loops")) {
    PiLoop pi;
    pi.input = indexByName(item, "input", names.inputs);
    pi.output = indexByName(item, "output", names.outputs);
    need(item, "kp", "a number");
    item.number("kp", pi.kp, kFinite);
    item.number("ki_per_h", pi.ki_per_h, kFinite);
    pi.bias = loop.simulation.actuator.initial[pi.input];
    item.number("bias", pi.bias, kFinite);
    item.boolean("reverse", pi.reverse);
    item.oneOf("anti_windup", pi.anti_windup, {"none", "clamp", "tracking"});
    item.oneOf("start", pi.start, {"bias", "bumpless"});
    pi.gain_schedule = readSchedule(item);
    item.finish();
    loop.pi.loops.push_back(std::move(pi));
  }
  checked(section, [&] { loop.pi.validate(count(names.outputs), count(names.inputs)); });
}

void defaultClp(ClpParams& clp, Eigen::Index n_y, Eigen::Index n_u) {
  clp.weight_perturbation = Vector::Ones(n_u);
  clp.weight_tracking = Vector::Zero(n_y);
  clp.weight_state_output = Vector::Ones(n_y);
  clp.weight_input = Vector::Ones(n_u);
  clp.increment_lower = Vector::Constant(n_u, -kInfinite);
  clp.increment_upper = Vector::Constant(n_u, kInfinite);
  clp.output_lower = Vector::Constant(n_y, -kInfinite);
  clp.output_upper = Vector::Constant(n_y, kInfinite);
}

void readTargets(YamlSection& section, ClpParams& clp, const std::vector<std::string>& outputs) {
  std::vector<std::string> targets;
  section.names("target_outputs", targets);
  for (const auto& target : targets) {
    const auto found = std::find(outputs.begin(), outputs.end(), target);
    if (found == outputs.end())
      throw InputError(section.where("target_outputs") + ": expected names out of " +
                       join(outputs) + ", got '" + target + "'");
    clp.target_outputs.push_back(static_cast<int>(found - outputs.begin()));
  }
}

void readClpParams(YamlSection& section, ClpParams& clp, const LoopNames& names) {
  section.integer("perturbation_steps", clp.perturbation_steps, 1, 1000);
  section.integer("mode2_steps", clp.mode2_steps, 0, 1000);
  section.oneOf("cost", clp.cost, {"least_perturbation", "lq"});
  section.byName("weight_perturbation", clp.weight_perturbation, names.inputs, kFinitePositive);
  section.byName("weight_tracking", clp.weight_tracking, names.outputs, kFiniteNotNegative);
  section.byName("weight_state_output", clp.weight_state_output, names.outputs, kFiniteNotNegative);
  section.byName("weight_input", clp.weight_input, names.inputs, kFinitePositive);
  section.oneOf("bounds", clp.bounds, {"absolute", "incremental"});
  section.byName("increment_lower", clp.increment_lower, names.inputs);
  section.byName("increment_upper", clp.increment_upper, names.inputs);
  section.oneOf("action", clp.action, {"eq26", "eq27"});
  readTargets(section, clp, names.outputs);
  section.byName("output_lower", clp.output_lower, names.outputs);
  section.byName("output_upper", clp.output_upper, names.outputs);
  section.number("output_penalty", clp.output_penalty, kFinitePositive);
  YamlSection qp = section.section("qp");
  qp.integer("max_iterations", clp.qp.max_iterations, 1);
  qp.number("feasibility_tolerance", clp.qp.feasibility_tolerance, kFinitePositive);
  checked(qp, [&] { clp.qp.validate(); });
  qp.finish();
}

}  // namespace

Vector nominalDisturbances(const LoopFile& loop, const LoopNames& names) {
  Vector nominal(count(names.seen_disturbances));
  for (Eigen::Index i = 0; i < nominal.size(); ++i) {
    const auto& all = names.disturbances;
    const auto at =
        std::find(all.begin(), all.end(), names.seen_disturbances[static_cast<std::size_t>(i)]);
    nominal[i] = loop.simulation.disturbance_nominal[at - all.begin()];
  }
  return nominal;
}

void readPredictionSteps(YamlSection& section, const LoopFile& loop, int& steps) {
  if (loop.has_clp) steps = loop.clp.perturbation_steps;
  section.integer("prediction_steps", steps, 1, 10000);
  if (loop.has_clp && steps != loop.clp.perturbation_steps)
    section.fail("prediction_steps",
                 "clp.perturbation_steps (" + std::to_string(loop.clp.perturbation_steps) + ")");
}

void readSetpoint(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("setpoint");
  SetpointParams& params = loop.setpoint;
  const Eigen::Index n_y = count(names.outputs);
  params.initial = defaultSetpoint(loop, names);
  params.lower = Vector::Constant(n_y, -kInfinite);
  params.upper = Vector::Constant(n_y, kInfinite);
  params.rate_per_h = Vector::Constant(n_y, kInfinite);
  section.byName("initial", params.initial, names.outputs, kFinite);
  if (!params.initial.allFinite())
    section.fail("initial", "a value for each of " + join(names.outputs));
  if (section.has("initial")) requireInRange(section, "initial", params.initial, loop.plant_info);
  for (auto& item : section.list("schedule")) {
    params.schedule.push_back(readSetpointStep(item, names.outputs));
    for (std::size_t i = 0; i < names.outputs.size(); ++i)
      requireInRange(item, names.outputs[i],
                     params.schedule.back().value[static_cast<Eigen::Index>(i)],
                     loop.plant_info.outputs[i]);
    if (params.schedule.size() > 1 &&
        params.schedule.end()[-2].time_h > params.schedule.back().time_h)
      item.fail("time_h", "times that do not decrease");
  }
  const std::vector<SetpointStep> recipe = readRecipe(section, names.outputs);
  if (!recipe.empty() && !params.schedule.empty())
    section.fail("recipe", "either schedule or recipe");
  for (const SetpointStep& entry : recipe)
    requireInRange(section, "recipe", entry.value, loop.plant_info);
  if (!recipe.empty()) params.schedule = recipe;
  section.byName("lower", params.lower, names.outputs);
  section.byName("upper", params.upper, names.outputs);
  section.byName("rate_per_h", params.rate_per_h, names.outputs, Range{0.0, kInfinite, true});
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
                     loop.plant_info.outputs[output]);
    scheduled.command.time_ns = clock.timeAt(clock.firstStepAtHours(scheduled.time_h));
    params.commands.push_back(std::move(scheduled.command));
  }
  checked(section, [&] { params.validate(n_y); });
  section.finish();
}

void readClp(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("clp");
  const bool there = root.has("clp") && !root.raw("clp").IsNull();
  bool enabled = there;
  section.boolean("enabled", enabled);
  loop.has_clp = there && enabled;
  const Eigen::Index n_y = count(names.outputs), n_u = count(names.inputs);
  defaultClp(loop.clp, n_y, n_u);
  readClpParams(section, loop.clp, names);
  if (loop.has_clp) checked(section, [&] { loop.clp.validate(n_y, n_u); });
  section.finish();
}

void readController(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("controller");
  const std::vector<std::string> types{"fmbpc", "fuzzy_optimal", "hybrid_mpc", "nmpc", "swarm_mpc",
                                       "pi",    "adaptive_pi",   "excitation"};
  need(section, "type", "one of " + join(types));
  loop.controller = "fmbpc";
  section.oneOf("type", loop.controller, types);
  if (loop.controller == "fmbpc") {
    readFmbpc(section, loop, names);
  } else if (loop.controller == "fuzzy_optimal") {
    readFuzzyOptimal(section, loop, names);
  } else if (loop.controller == "hybrid_mpc") {
    readHybridMpc(section, loop, names);
  } else if (loop.controller == "nmpc" || loop.controller == "swarm_mpc") {
    readHorizonMpc(section, loop, names);
  } else if (loop.controller == "adaptive_pi") {
    readAdaptivePi(section, loop, names);
  } else if (loop.controller == "excitation") {
    readExcitation(section, loop, names);
  } else {
    readPi(section, loop, names);
  }
  section.finish();
  if (loop.has_clp && loop.controller != "fmbpc" && loop.controller != "fuzzy_optimal")
    section.fail("type",
                 "a controller that predicts (fmbpc, fuzzy_optimal) for clp; clp.enabled: false "
                 "switches the "
                 "optimizer off");
}

}  // namespace fpc
