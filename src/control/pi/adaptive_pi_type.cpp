// Controller type adaptive_pi: its section of a loop file.
#include <algorithm>

#include "control/pi/adaptive_pi.hpp"
#include "control/pi/decoupling.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

void readLoops(YamlSection& section, AdaptivePiParams& params, const ControllerContext& context) {
  need(section, "loops", "a list of two loops");
  auto items = section.list("loops");
  if (items.size() != 2) section.fail("loops", "two loops");
  for (std::size_t i = 0; i < 2; ++i) {
    AdaptiveLoop& loop = params.loops[i];
    YamlSection& item = items[i];
    loop.input = indexByName(item, "input", context.inputs());
    loop.output = indexByName(item, "output", context.outputs());
    for (const char* key : {"kp", "ki_per_h"}) need(item, key, "a number");
    item.number("kp", loop.kp, kFinite);
    item.number("ki_per_h", loop.ki_per_h, kFinite);
    item.finish();
  }
}

/// Index of the loop whose output (or input) it is.
std::size_t loopOf(const AdaptivePiParams& params, int index, int AdaptiveLoop::*signal) {
  return params.loops[0].*signal == index ? 0 : 1;
}

void readElements(YamlSection& section, AdaptivePiParams& params,
                  const ControllerContext& context) {
  for (auto& item : section.list("model")) {
    const int output = indexByName(item, "output", context.outputs());
    const int input = indexByName(item, "from", context.inputs());
    Fopdt& element = params.model[loopOf(params, output, &AdaptiveLoop::output)]
                                 [loopOf(params, input, &AdaptiveLoop::input)];
    if (element.gain != 0.0) item.fail("output", "every pair of output and input only once");
    for (const char* key : {"gain", "time_constant_min"}) need(item, key, "a number");
    item.number("gain", element.gain, kFinite);
    item.number("time_constant_min", element.time_constant, kFinitePositive);
    item.number("dead_time_min", element.dead_time, kFiniteNotNegative);
    item.finish();
  }
}

/// An element that nobody wrote would be told as one whose gain is 0.
void requireElements(const YamlSection& section, const AdaptivePiParams& params,
                     const ControllerContext& context) {
  const bool needed = params.decoupling || params.adaptation.enabled;
  const bool paired = params.loops[0].input != params.loops[1].input &&
                      params.loops[0].output != params.loops[1].output;
  if (!needed || !paired) return;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) {
      if (params.model[i][j].gain != 0.0) continue;
      const auto y = static_cast<std::size_t>(params.loops[i].output);
      const auto u = static_cast<std::size_t>(params.loops[j].input);
      section.fail("model", "an item with a gain other than 0 for every pair; " +
                                context.outputs()[y] + " from " + context.inputs()[u] + " lacks");
    }
}

void readAdaptation(YamlSection& section, AdaptationParams& params) {
  bool off = false;
  YamlSection item = section.sectionOrOff("adaptation", off);
  params.enabled = section.has("adaptation") && !off;
  item.finish();
}

AdaptivePiParams readAdaptivePi(YamlSection& section, const ControllerContext& context) {
  AdaptivePiParams params;
  if (context.outputCount() != 2 || context.inputCount() != 2)
    section.fail("type", "a plant of two inputs and two outputs for adaptive_pi");
  readLoops(section, params, context);
  section.boolean("decoupling", params.decoupling);
  readElements(section, params, context);
  readAdaptation(section, params.adaptation);
  requireElements(section, params, context);
  checked(section, [&] {
    params.validate(2, 2);
    if (params.decoupling) InvertedDecoupling(params.model, context.plant.sample_time_s / 60.0);
  });
  return params;
}

/// Both outputs; it looks at no disturbance.
SignalUse usedByAdaptivePi(const AdaptivePiParams&, const ControllerContext& context) {
  SignalUse use = everySignal(context);
  std::fill(use.needed.begin() + context.outputCount(), use.needed.end(), false);
  return use;
}

std::unique_ptr<Controller> makeAdaptivePi(const AdaptivePiParams& params,
                                           const ControllerContext& context) {
  return std::make_unique<AdaptivePi>(params, context.limits, context.plant);
}

const bool kAdaptivePiRegistered = registerController<AdaptivePiParams>(
    {{"adaptive_pi", "two PI loops behind a decoupling, retuned from gains learned on line"},
     &readAdaptivePi,
     &makeAdaptivePi,
     nullptr,
     &usedByAdaptivePi});

}  // namespace
}  // namespace fpc
