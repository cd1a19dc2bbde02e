// Controller type excitation: its section of a loop file. Times are a whole number of
// samples.
#include "control/excitation/excitation.hpp"
#include "fmbpc/base/option.hpp"

#include <cmath>
#include <set>

#include "fmbpc/base/text.hpp"
#include "fmbpc/control/registry.hpp"

namespace fpc {
namespace {

constexpr double kMostSamples = 2e9;       // of one duration
constexpr double kSampleTolerance = 1e-6;  // of a sample: decimal times are rounded

/// Samples in a time. @throws InputError unless they are whole.
std::int64_t wholeSamples(const YamlSection& section, const std::string& key, double time_s,
                          double sample_time_s) {
  const double samples = time_s / sample_time_s, whole = std::round(samples);
  if (std::abs(samples - whole) > kSampleTolerance || whole > kMostSamples)
    section.fail(key, "a whole number of samples of " + exactText(sample_time_s) + " s");
  return static_cast<std::int64_t>(whole);
}

void readRegister(YamlSection& item, ExcitationSignal& signal, double sample_time_s) {
  double clock_s = sample_time_s;
  item.number("clock_s", clock_s, kFiniteNotNegative);
  signal.clock_steps = static_cast<int>(wholeSamples(item, "clock_s", clock_s, sample_time_s));
  if (signal.clock_steps < 1) item.fail("clock_s", "at least 1 sample");
}

void readHolds(YamlSection& item, ExcitationSignal& signal, double sample_time_s) {
  item.numbers("levels", signal.levels, kFinite);
  if (item.has("levels") && item.has("range")) item.fail("levels", "either levels or a range");
  if (item.has("levels") && signal.levels.empty()) item.fail("levels", "at least one number");
  double shortest_s = 0.0, longest_s = 0.0;
  if (!item.interval("hold_s", shortest_s, longest_s, kFiniteNotNegative, "[shortest, longest]"))
    item.fail("hold_s", "[shortest, longest] time of a level");
  const auto samples = [&](double time_s) {
    const std::int64_t whole = wholeSamples(item, "hold_s", time_s, sample_time_s);
    if (whole < 1) item.fail("hold_s", "at least 1 sample");
    return static_cast<int>(whole);
  };
  signal.hold_lower_steps = samples(shortest_s);
  signal.hold_upper_steps = samples(longest_s);
}

void readStaircase(YamlSection& item, ExcitationSignal& signal, double sample_time_s) {
  need(item, "schedule", "a list of times and values");
  for (auto& entry : item.list("schedule")) {
    double time_h = 0.0;
    ExcitationStep step;
    need(entry, "time_h", "a time >= 0");
    entry.number("time_h", time_h, {0.0, 1e7});
    step.step = wholeSamples(entry, "time_h", 3600.0 * time_h, sample_time_s);
    if (!signal.schedule.empty() && step.step <= signal.schedule.back().step)
      entry.fail("time_h", "times that increase");
    need(entry, "value", "a number");
    entry.number("value", step.value, kFinite);
    entry.finish();
    signal.schedule.push_back(step);
  }
}

ExcitationSignal readSignal(YamlSection& item, const ControllerContext& loop) {
  ExcitationSignal signal;
  const double sample_time_s = loop.plant.sample_time_s;
  signal.input = indexByName(item, "input", loop.inputs());
  need(item, "signal", "one of prbs, multi_level, steps, none");
  readOption(item, "signal", signal.signal);
  const InputLimits& limits = loop.limits;
  const Range bounds{limits.lower[signal.input], limits.upper[signal.input]};
  if (signal.signal == ExcitationKind::kPrbs || signal.signal == ExcitationKind::kMultiLevel) {
    signal.lower = bounds.lower;
    signal.upper = bounds.upper;
    item.interval("range", signal.lower, signal.upper, bounds);
  }
  if (signal.signal == ExcitationKind::kPrbs) readRegister(item, signal, sample_time_s);
  if (signal.signal == ExcitationKind::kMultiLevel) readHolds(item, signal, sample_time_s);
  if (signal.signal == ExcitationKind::kSteps) readStaircase(item, signal, sample_time_s);
  item.finish();
  return signal;
}

ExcitationFeedback readFeedback(YamlSection& item, const ControllerContext& loop) {
  ExcitationFeedback feedback;
  feedback.input = indexByName(item, "input", loop.inputs());
  feedback.output = indexByName(item, "output", loop.outputs());
  need(item, "gain", "a number");
  item.number("gain", feedback.gain, kFinite);
  item.finish();
  return feedback;
}

ExcitationParams readExcitation(YamlSection& section, const ControllerContext& loop) {
  ExcitationParams params;
  params.seed = loop.seed;
  need(section, "signals", "a list of signals, one for each input that moves");
  std::set<int> moved;
  for (auto& item : section.list("signals")) {
    params.signals.push_back(readSignal(item, loop));
    if (!moved.insert(params.signals.back().input).second)
      item.fail("input", "an input that no other signal moves");
  }
  for (auto& item : section.list("feedback")) params.feedback.push_back(readFeedback(item, loop));
  checked(section, [&] { params.validate(loop.limits, loop.outputCount()); });
  return params;
}

std::unique_ptr<Controller> makeExcitation(const ExcitationParams& params,
                                           const ControllerContext& loop) {
  return std::make_unique<ExcitationController>(params, loop.limits, loop.initial_input,
                                                loop.plant);
}

SignalUse usedByExcitation(const ExcitationParams& params, const ControllerContext& loop) {
  SignalUse use = everySignal(loop);
  std::vector<int> moved;
  for (const ExcitationSignal& signal : params.signals)
    if (signal.signal != ExcitationKind::kNone) moved.push_back(signal.input);
  for (const ExcitationFeedback& feedback : params.feedback) moved.push_back(feedback.input);
  use.moved = theseInputs(loop, moved);
  return use;
}

ControllerType describeExcitation() {
  ControllerType type{"excitation", "an experiment for identification: every input its own signal"};
  type.open_loop = true;
  return type;
}

const bool kExcitationRegistered = registerController<ExcitationParams>(
    {describeExcitation(), &readExcitation, &makeExcitation, nullptr, &usedByExcitation});

}  // namespace
}  // namespace fpc
