// Indices of a run from its samples. Samples that never came are left out (a complete run has
// none).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "analysis/running_indices.hpp"
#include "runtime/factory.hpp"
#include "runtime/model_use.hpp"
#include "runtime/run_events.hpp"
#include "runtime/run_summary.hpp"
#include "runtime/run_tally.hpp"

namespace fpc {
namespace {

using Index = Eigen::Index;

constexpr double kTolerance = 1e-9;  // of an input's range

double toleranceOf(const InputLimits& limits, Index i) {
  const double range = limits.upper[i] - limits.lower[i];
  return kTolerance * (std::isfinite(range) ? range : 1.0);
}

bool isOfLaw(ActionSource source) {
  return source == ActionSource::kBase || source == ActionSource::kConstrained ||
         source == ActionSource::kClipped || source == ActionSource::kGuarded;
}

/// What stands in a summary before the first sample.
Summary blank(const LoopFile& loop) {
  Summary summary;
  summary.loop = loop.name;
  summary.title = loop.report.title;
  summary.limits = loop.simulation.actuator.limits;
  summary.output_lower = loop.report.output_lower;
  summary.output_upper = loop.report.output_upper;
  summary.has_clp = loop.has_clp;
  summary.controlled.assign(loop.plant_info.outputs.size(), false);
  if (loop.controller)
    for (const Index i : loop.controller->signalUse(controllerContext(loop)).followed)
      summary.controlled[static_cast<std::size_t>(i)] = true;
  for (const auto& output : loop.plant_info.outputs) {
    summary.output_names.push_back(output.name);
    summary.output_units.push_back(output.unit);
    for (const auto& window : loop.report.windows)
      if (window.output.empty() || window.output == output.name)
        summary.windows.push_back({window, output.name, 0.0, 0.0, 0});
  }
  for (const auto& input : loop.plant_info.inputs) {
    summary.input_names.push_back(input.name);
    summary.input_units.push_back(input.unit);
  }
  for (const Consumption& item : loop.report.consumption)
    summary.consumption.emplace_back(item.name, 0.0);
  summary.sources.assign(static_cast<std::size_t>(ActionSource::kGuarded) + 1, 0);
  return summary;
}

}  // namespace

struct RunSummary::Sums {
  explicit Sums(const LoopFile& of, std::uint32_t first_step)
      : loop(of),
        sample_time_h(of.plant_info.sample_time_s / 3600.0),
        summary(blank(of)),
        outputs(of.plant_info.outputs.size(), RunningOutput(sample_time_h)),
        rejected(of),
        events(of, first_step),
        step(first_step) {
    summary.first_step = first_step;
  }

  std::optional<double> scored(const SampleRecord& sample, std::size_t i) const;
  void followOutputs(const SampleRecord& sample);
  void followWindows(const SampleRecord& sample);
  void followInputs(const SampleRecord& sample);
  void countAction(const SampleRecord& sample);
  double moveOf(const SampleRecord& sample, Index i, double tolerance) const;
  void countState(const SampleRecord& sample);
  void countSolve(const SampleRecord& sample);

  LoopFile loop;
  double sample_time_h;
  Summary summary;
  std::vector<RunningOutput> outputs;
  std::vector<RunningInput> inputs;  // from sample 0 on
  Rejections rejected;               // by the controller
  LogHistogram solve_us;
  RunTally tally;
  RunEvents events;
  ControlAction last;  // of the sample before, without an input if there was none
  std::uint32_t step{};
};

/// Output i of a sample as it counts: what was measured, in place of what was rejected the plant's
/// own value, where it is known.
std::optional<double> RunSummary::Sums::scored(const SampleRecord& sample, std::size_t i) const {
  const auto k = static_cast<Index>(i);
  if (!rejected.of(i)) return sample.measurement.outputs[k];
  return sample.has_state ? std::optional<double>(sample.state.outputs[k]) : std::nullopt;
}

void RunSummary::Sums::followOutputs(const SampleRecord& sample) {
  if (!sample.has_measurement || !sample.has_tracking) return;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const auto k = static_cast<Index>(i);
    if (const auto y = scored(sample, i))
      outputs[i].add(*y, sample.tracking.setpoint[k], sample.tracking.reference[k]);
    else
      outputs[i].reject();
  }
  followWindows(sample);
}

void RunSummary::Sums::followWindows(const SampleRecord& sample) {
  const double time_h = static_cast<double>(step) * sample_time_h;
  const double rounding = 1e-6 * sample_time_h;
  for (WindowIndices& sums : summary.windows) {
    const ReportWindow& window = sums.window;
    if (time_h < window.from_h - rounding || time_h > window.to_h + rounding) continue;
    const auto& names = summary.output_names;
    const Index i = std::find(names.begin(), names.end(), sums.output) - names.begin();
    const auto y = scored(sample, static_cast<std::size_t>(i));
    if (!y) continue;
    const double error = *y - sample.tracking.setpoint[i];
    sums.mean_error += error;
    sums.rmse += error * error;
    ++sums.samples;
  }
}

/// u(k) is known from the measurement that follows it.
void RunSummary::Sums::followInputs(const SampleRecord& sample) {
  const bool known = sample.has_measurement;
  for (std::size_t i = 0; i < summary.input_names.size(); ++i) {
    const double value = known ? sample.measurement.input_applied[static_cast<Index>(i)]
                               : std::numeric_limits<double>::quiet_NaN();
    if (inputs.size() <= i)
      inputs.emplace_back(value);
    else if (known)
      inputs[i].add(value);
  }
  if (step == summary.first_step || !known) return;
  for (std::size_t i = 0; i < summary.consumption.size(); ++i)
    summary.consumption[i].second +=
        loop.report.consumption[i].rate.dot(sample.measurement.input_applied) *
        loop.plant_info.sample_time_s;
}

void RunSummary::Sums::countAction(const SampleRecord& sample) {
  if (!sample.has_action) return;
  const InputLimits& limits = summary.limits;
  ++summary.steps;
  ++summary.sources[static_cast<std::size_t>(sample.action.source)];
  for (Index i = 0; i < sample.action.input.size(); ++i) {
    const double u = sample.action.input[i], tolerance = toleranceOf(limits, i);
    const bool inside = u >= limits.lower[i] - tolerance && u <= limits.upper[i] + tolerance;
    summary.input_violations += !inside;
    if (!sample.has_measurement) continue;
    summary.move_violations += !(moveOf(sample, i, tolerance) <= limits.move[i] + tolerance);
  }
}

/// The move of command i: from the command before it; from what is read where the plant shows that
/// one, where there was none, and, if that is shorter, where somebody else than the law acted.
double RunSummary::Sums::moveOf(const SampleRecord& sample, Index i, double tolerance) const {
  const double u = sample.action.input[i], applied = sample.measurement.input_applied[i];
  const double from_read = std::abs(u - applied);
  if (last.input.size() == 0 || std::abs(applied - last.input[i]) <= tolerance) return from_read;
  const double from_command = std::abs(u - last.input[i]);
  const bool of_law = isOfLaw(last.source) && isOfLaw(sample.action.source);
  return of_law ? from_command : std::min(from_command, from_read);
}

void RunSummary::Sums::countState(const SampleRecord& sample) {
  if (!sample.has_state) return;
  summary.actuator_clips += sample.state.actuator_clips;
  for (Index i = 0; i < sample.state.outputs.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = sample.state.outputs[i];
    summary.output_violations += !(y >= summary.output_lower[k] && y <= summary.output_upper[k]);
  }
}

void RunSummary::Sums::countSolve(const SampleRecord& sample) {
  const SolveStatus status = sample.report.status;
  if (!loop.has_clp || !sample.has_report || status == SolveStatus::kNotRun) return;
  solve_us.add(1e6 * sample.report.seconds);
  if (status == SolveStatus::kInfeasible)
    ++summary.clp_infeasible;
  else if (status != SolveStatus::kSolved && status != SolveStatus::kBoundWins)
    ++summary.clp_failed;
}

RunSummary::RunSummary(const LoopFile& loop, std::uint32_t first_step)
    : sums_(std::make_unique<Sums>(loop, first_step)) {}
RunSummary::RunSummary(RunSummary&&) noexcept = default;
RunSummary::~RunSummary() = default;

void RunSummary::add(const SampleRecord& sample) {
  sums_->rejected.look(sample);
  sums_->followOutputs(sample);
  sums_->followInputs(sample);
  sums_->countState(sample);
  sums_->countAction(sample);
  sums_->countSolve(sample);
  sums_->tally.add(sample);
  sums_->events.add(sample, sums_->rejected);
  sums_->last = sample.has_action ? sample.action : ControlAction();
  ++sums_->step;
}

Summary RunSummary::finish(double wall_s, bool nothing_missing) const {
  Summary result = sums_->summary;
  result.wall_s = wall_s;
  result.failed_samples = sums_->tally.failed_samples;
  result.trouble = sums_->tally.trouble;
  result.outside_model = sums_->events.outsideModel();
  result.complete = nothing_missing && result.failed_samples == 0;
  EventList events = sums_->events.finish();
  if (!nothing_missing) events.add(eventOf(EventCode::kRunIncomplete));
  addFileEvents(sums_->loop, events);
  result.events = events.all();
  for (const RunningOutput& output : sums_->outputs) result.outputs.push_back(output.indices());
  for (const Event& event : result.events)
    for (std::size_t i = 0; i < result.outputs.size(); ++i)
      if (event.code == EventCode::kMeasurementRejected && event.signal == result.output_names[i])
        result.outputs[i].rejected += event.count;
  for (const RunningInput& input : sums_->inputs) result.inputs.push_back(input.indices());
  result.inputs.resize(result.input_names.size());  // of a run without samples
  for (WindowIndices& window : result.windows) {
    const auto n = static_cast<double>(window.samples);
    window.rmse = std::sqrt(window.rmse / n);
    window.mean_error /= n;
  }
  result.clp_solves = sums_->solve_us.count();
  result.clp_median_us = sums_->solve_us.quantile(0.5);
  result.clp_p99_us = sums_->solve_us.quantile(0.99);
  return result;
}

}  // namespace fpc
