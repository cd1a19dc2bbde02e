// Controller type hybrid_mpc: its section of a loop file: which inputs there are, which of them may
// follow each other, what they cost.
#include <cmath>

#include "control/hybrid/evolution.hpp"
#include "control/hybrid/hybrid_mpc.hpp"
#include "fmbpc/base/option.hpp"
#include "fmbpc/base/signals.hpp"
#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

using Eigen::Index;

/// Values by name; NaN where a name is absent: any value.
Vector readPattern(YamlSection& item, const std::vector<std::string>& names) {
  Vector values = Vector::Constant(countOf(names), std::nan(""));
  for (Index i = 0; i < values.size(); ++i)
    item.number(names[static_cast<std::size_t>(i)], values[i], kFinite);
  item.finish();
  return values;
}

std::vector<Vector> readList(YamlSection& section, const std::vector<std::string>& names) {
  std::vector<Vector> inputs;
  for (auto& item : section.list("inputs")) {
    inputs.push_back(readPattern(item, names));
    if (!inputs.back().allFinite()) item.fail("", "a value for each of " + join(names));
  }
  return inputs;
}

Matrix readChoices(YamlSection& section, const std::vector<std::string>& names) {
  const std::vector<Vector> inputs = readList(section, names);
  if (inputs.empty()) section.fail("inputs", "a list of input vectors");
  Matrix choices(countOf(names), static_cast<Index>(inputs.size()));
  for (std::size_t i = 0; i < inputs.size(); ++i) choices.col(static_cast<Index>(i)) = inputs[i];
  return choices;
}

void readTransitions(YamlSection& section, const std::vector<std::string>& names,
                     std::vector<ForbiddenTransition>& transitions) {
  for (auto& item : section.list("forbidden_transitions")) {
    ForbiddenTransition t;
    t.from = t.to = Vector::Constant(countOf(names), std::nan(""));
    item.byName("from", t.from, names, kFinite);
    item.byName("to", t.to, names, kFinite);
    item.finish();
    transitions.push_back(std::move(t));
  }
}

void readCost(YamlSection& controller, HybridMpcParams& params, const ControllerContext& loop) {
  YamlSection cost = controller.section("cost");
  params.weight_tracking = Vector::Zero(loop.outputCount());
  cost.byName("tracking", params.weight_tracking, loop.outputs(), kFiniteNotNegative);
  for (auto& item : cost.list("switching")) {
    SwitchTerm term;
    term.before = indexByName(item, "before", loop.inputs());
    term.after = indexByName(item, "after", loop.inputs());
    need(item, "weight", "a number >= 0");
    item.number("weight", term.weight, kFiniteNotNegative);
    item.finish();
    params.switching.push_back(term);
  }
  for (auto& item : cost.list("travel")) {
    TravelTerm term;
    term.input = indexByName(item, "input", loop.inputs());
    if (item.has("gate"))
      term.gate = indexByName(item, "gate", loop.inputs());
    else
      item.markRead("gate");
    need(item, "weight", "a number >= 0");
    item.number("weight", term.weight, kFiniteNotNegative);
    item.finish();
    params.travel.push_back(term);
  }
  cost.finish();
}

HybridMpcParams readHybridMpc(YamlSection& section, const ControllerContext& loop) {
  HybridMpcParams params;
  params.preview = false;
  params.choices = readChoices(section, loop.inputs());
  readTransitions(section, loop.inputs(), params.forbidden_transitions);
  section.integer("hold_samples", params.hold_samples, 1, 100000);
  section.integer("horizon_blocks", params.horizon_blocks, 1, 1000);
  section.boolean("preview", params.preview);
  readCost(section, params, loop);
  readOption(section, "bound", params.bound);
  checked(section, [&] {
    params.validate(loop.outputCount(), loop.inputCount());
    params.validateLimits(loop.limits);
  });
  require(params.mayBeSent(loop.fallback_input), "actuator.fallback", "one of controller.inputs");
  return params;
}

std::unique_ptr<Controller> makeHybridMpc(const HybridMpcParams& params,
                                          const ControllerContext& loop) {
  return std::make_unique<HybridMpc>(params, loop.limits, loop.plant);
}

ControllerType describeHybridMpc() {
  ControllerType type{"hybrid_mpc", "the best sequence out of a set of input vectors, by search"};
  type.needs_model = true;
  return type;
}

const bool kHybridMpcRegistered =
    registerController<HybridMpcParams>({describeHybridMpc(), &readHybridMpc, &makeHybridMpc});

}  // namespace
}  // namespace fpc
