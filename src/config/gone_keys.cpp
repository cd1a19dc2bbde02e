#include "config/gone_keys.hpp"

#include <utility>
#include <vector>

#include "base/split.hpp"
#include "base/yaml_node.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

/// Key, and its successor; `*` is any name. Keys of a list stand below it, without a number.
constexpr std::pair<const char*, const char*> kGone[] = {
    {"clp.enabled", "'clp: false' to take the section out"},
    {"guard.enabled", "'guard: false' to take the section out"},
    {"plausibility.enabled", "'plausibility: false' to take the section out"},
    {"standstill.enabled", "'standstill: false' to take the section out"},
    {"targets.enabled", "'targets: false' to take the section out"},
    {"controller.observer.enabled", "'controller.observer: false' to take the section out"},
    {"controller.adaptation.enabled", "'controller.adaptation: {}', or false to take it out"},
    {"model.identify.online.enabled", "'model.identify.online: {}', or false to take it out"},
    {"controller.swarm.inertia_start", "no key: it is 0.9"},
    {"controller.swarm.inertia_end", "no key: it is 0.4"},
    {"controller.swarm.cognitive", "no key: it is 1.8"},
    {"controller.swarm.social", "no key: it is 1.8"},
    {"controller.swarm.speed_upper", "no key: it is 0.5"},
    {"guard.pi", "guard.fallback with type: pi"},
    {"guard.least_move", "no key: it is 0.25"},
    {"guard.lock_error", "no key: it is 0.01"},
    {"guard.lock_step", "no key: it is 0.3"},
    {"guard.lock_release", "no key: it is 250"},
    {"guard.lock_outputs", "no key: outputs with a weight count"},
    {"guard.swing_move", "guard.growing_swings with guard.fallback"},
    {"guard.swing_release", "guard.growing_swings with guard.fallback"},
    {"standstill.others_change", "no key: it is 0.1"},
    {"standstill.noise_std", "noise.std or sensors.NAME.noise_std"},
    {"standstill.fallback_plan", "standstill.fallback with type: pi, kp: 0, bias and feedforward"},
    {"model.identify.online.initial_covariance", "no key: it is 1"},
    {"model.identify.online.covariance_bound", "no key: it is 100"},
    {"controller.adaptation.initial_covariance", "no key: it is 100"},
    {"controller.adaptation.covariance_bound", "no key: it is 10000"},
    {"controller.adaptation.bias", "no key: it is true"},
    {"controller.adaptation.excitation_lower", "no key: it is 0"},
    {"controller.adaptation.change_upper", "no key: it is 0.1"},
    {"controller.adaptation.ratio_upper", "no key: it is 2"},
    {"controller.adaptation.deviation_upper", "no key: it is 0.1"},
    {"controller.adaptation.refused_steps", "no key: it is 60"},
    {"controller.tuning", "kp and ki_per_h in controller.loops; fmbpc tune finds them"},
    {"controller.loops.imc_time_constant_min", "kp and ki_per_h"},
    {"controller.loops.integral_time_min", "ki_per_h: 60 kp / Ti"},
    {"controller.integral_time_h", "type: pi with ki_per_h: kp / Ti"},
    {"controller.integral_limit", "type: pi; its integral has no limit of its own"},
    {"controller.tracking_time_h", "type: pi with tracking_time_h of a loop"},
    {"controller.load", "type: pi with feedforward: [{disturbance, times, gain}] of a loop"},
    {"clp.qp.feasibility_tolerance", "no key: it is 1e-10"},
    {"controller.transfer_decay", "no key: it is 0.9"},
    {"controller.disturbance_nominal", "disturbance.nominal"},
    {"controller.forecast_pole", "no key: it is 0.975"},
    {"controller.offset_gain", "no key: it is 0.2"},
    {"gateway.modbus.timeout_s", "no key: it is 2.5 times poll_s, within 0.5 and 2"},
    {"gateway.modbus.reconnect_s", "no key: it is 5 times poll_s, 1 at most"},
    {"controller.observer.adaptive", "controller.observer.noise_std"},
    {"controller.observer.adaptation", "controller.observer.noise_std"},
    {"targets.observer.adaptive", "targets.observer.noise_std"},
    {"targets.observer.adaptation", "targets.observer.noise_std"},
    {"targets.iterations", "no key: it is 5"},
    {"targets.outputs.*.setpoint_rank", "targets.outputs.NAME.rank"},
    {"candidate.horizon", "no key: it is 20"},
    {"candidate.confidence", "no key: it is 0.99"},
    {"candidate.step_samples", "no key: it is 50"},
    {"controller.levels", "controller.inputs with every allowed vector"},
    {"controller.forbidden", "controller.inputs with every allowed vector"},
    {"controller.time_budget_s", "no key: 1000000 nodes are searched"},
    {"plant.frame_id", "plant.name"},
    {"loop.optimizer_timeout_s", "no key: it is 1"},
    {"loop.commands_per_s", "no key: it is 20"},
    {"plausibility.stuck_tolerance", "no key: it is 0.02"},
    {"plausibility.hold_samples", "actuator.hold_samples"},
    {"tf.frames.*.x", "position: [x, y, z]"},
    {"tf.frames.*.y", "position: [x, y, z]"},
    {"tf.frames.*.z", "position: [x, y, z]"},
    {"controller.model.input", "from"},
    {"report.title", "title"},
    {"setpoint.recipe", "setpoint.schedule, with time_h and ramp_h"},
    {"report.windows.from_min", "between_s: [from, to]"},
    {"report.windows.from_h", "between_s: [from, to]"},
    {"report.windows.to_min", "between_s: [from, to]"},
    {"report.windows.to_h", "between_s: [from, to]"},
    {"report.windows.from_s", "between_s: [from, to]"},
    {"report.windows.to_s", "between_s: [from, to]"},
    {"controller.signals.clock_steps", "clock_s"},
    {"controller.signals.hold_lower_steps", "hold_s: [shortest, longest]"},
    {"controller.signals.hold_upper_steps", "hold_s: [shortest, longest]"},
    {"controller.signals.start_steps", "no key: it is 0"},
    {"controller.signals.hold_lower_s", "hold_s: [shortest, longest]"},
    {"controller.signals.hold_upper_s", "hold_s: [shortest, longest]"},
    {"controller.signals.start_s", "no key: it is 0"},
    {"controller.antecedent", "no key: realisation literal takes measured outputs"},
    {"controller.rules.weight_input", "controller.weight_input"},
    {"controller.cost.consumption", "controller.cost.travel or switching"},
    {"controller.max_iterations", "no key: it is 30"},
    {"controller.swarm.seed", "no key: it is 1"},
    {"controller.loops.schedule_by", "no key: it is the loop's output"},
    {"controller.loops.feedforward.nominal", "disturbance.nominal"},
    {"controller.loops.feedforward.lead_h", "no key: it is 0"},
    {"controller.adaptation.forgetting", "no key: it is 0.98"},
    {"controller.adaptation.start_steps", "no key: it is 60"},
    {"plant.matrix.title", "title"},
    {"sampling.start_time_s", "no key: it is 1"},
    {"model.identify.window", "no key: it is 100000"},
    {"model.identify.validation_share", "no key: it is 0.3"},
    {"sensors.*.lags", "no key: it is 1, or that of class"},
    {"sensors.*.stuck_from_h", "stuck_h: [from, to]"},
    {"sensors.*.stuck_to_h", "stuck_h: [from, to]"},
    {"gateway.tags.*.readback_table", "table"},
    {"gateway.tags.*.word_order", "gateway.modbus.word_order"},
    {"plausibility.margin", "no key: it is 0.1; range of the signal"},
    {"plausibility.gain_sign", "no key: it is true"},
    {"plausibility.stuck_samples", "no key: it is 5"},
    {"plausibility.plant_bounds", "no key: it is say"},
    {"plausibility.signals.*.jump_samples", "no key: it is 3"},
    {"plausibility.signals.*.repeated", "frozen"},
    {"standstill.usual", "disturbance.nominal"},
    {"clp.target_outputs",
     "no key: the outputs that the law steers, where there are more of them than inputs"},
    {"clp.mode2_steps", "a larger clp.perturbation_steps"},
    {"clp.action", "no key: it is eq26"},
    {"controller.disturbance_feedforward", "no key: it is true"},
    {"sensors.seed", "seed"},
    {"noise.seed", "seed"},
    {"disturbance.pattern.seed", "seed"},
    {"controller.seed", "seed"},
    {"estimator.initial_std", "no key: it is a tenth of estimator.initial"},
    {"disturbance.csv.channels.*.implausible", "disturbance.csv.missing"},
    {"plausibility.reaction", "no key: it is say"},
    {"clp.weight_state_output", "no key: it is 1"},
    {"clp.weight_input", "no key: it is 1"},
    {"sensors.*.class_noise", "noise_std: 2.5 % of the range"},
    {"controller.disturbance_gain", "no key: it is 1"},
    {"targets.inputs.*.rank", "rest, behind the prices"},
    {"sensors.*.lower", "range: [lower, upper]"},
    {"sensors.*.upper", "range: [lower, upper]"},
    {"disturbance.pattern.channels.*.lower", "range: [lower, upper]"},
    {"disturbance.pattern.channels.*.upper", "range: [lower, upper]"},
    {"plausibility.signals.*.lower", "range: [lower, upper]"},
    {"plausibility.signals.*.upper", "range: [lower, upper]"},
    {"controller.signals.lower", "range: [lower, upper]"},
    {"controller.signals.upper", "range: [lower, upper]"},
    {"targets.outputs.*.lower", "zone: [lower, upper]"},
    {"targets.outputs.*.upper", "zone: [lower, upper]"},
    {"targets.inputs.*.lower", "range: [lower, upper]"},
    {"targets.inputs.*.upper", "range: [lower, upper]"},
    {"guard.trust_low", "trust: [low, high]"},
    {"guard.trust_high", "trust: [low, high]"},
    {"candidate.authority", "no key: it is [0.25, 0.5, 1]"},
    {"candidate.samples", "no key: it is 200"},
    {"controller.integration_steps", "no key: it is 4"},
    {"plausibility.bridge_samples", "no key: it is 3"},
    {"controller.node_budget", "no key: it is 1000000"},
    {"controller.signals.register_bits", "no key: it is 10"}};

/// Paths of the mappings at the parts but the last, which hold the last one.
void findIn(const YAML::Node& node, const std::vector<std::string>& parts, std::size_t index,
            const std::string& place, std::vector<std::string>& found) {
  if (node.IsSequence())
    for (std::size_t i = 0; i < node.size(); ++i)
      findIn(node[i], parts, index, place + "[" + std::to_string(i) + "]", found);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    const std::string key = entry.first.Scalar();
    if (key != parts[index] && parts[index] != "*") continue;
    if (index + 1 == parts.size())
      found.push_back(place);
    else
      findIn(entry.second, parts, index + 1, place + "." + key, found);
  }
}

}  // namespace

void explainGoneKeys(const YamlSection& root, const std::string& error) {
  for (const auto& [key, instead] : kGone) {
    const auto parts = split(key, '.');
    if (!root.has(parts[0])) continue;
    std::vector<std::string> found;
    findIn(root.raw(parts[0]), parts, 1, parts[0], found);
    for (const auto& place : found)
      if (error.find(place) != std::string::npos)
        throw InputError(root.where(place + "." + parts.back()) + ": the key went; expected " +
                         instead);
  }
}

}  // namespace fpc
