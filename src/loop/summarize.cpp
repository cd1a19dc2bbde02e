// Indices of a run from its record. Samples that never came are left out (a complete run has none).
#include <algorithm>
#include <cmath>
#include <limits>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/config/disturbance_source.hpp"
#include "fmbpc/loop/factory.hpp"
#include "fmbpc/loop/report.hpp"

namespace fpc {
namespace {

constexpr double kTolerance = 1e-9;  // of an input's range

Vector toVector(const std::vector<double>& values) {
  return Eigen::Map<const Vector>(values.data(), static_cast<Eigen::Index>(values.size()));
}

OutputIndices indicesOfOutput(const RunRecord& record, Eigen::Index i, double sample_time_h) {
  std::vector<double> y, setpoint, reference;
  for (const auto& sample : record.samples) {
    if (!sample.has_measurement || !sample.has_tracking) continue;
    y.push_back(sample.measurement.outputs[i]);
    setpoint.push_back(sample.tracking.setpoint[i]);
    reference.push_back(sample.tracking.reference[i]);
  }
  return outputIndices(toVector(y), toVector(setpoint), toVector(reference), sample_time_h);
}

/// u(k) is known from the measurement that follows it.
InputIndices indicesOfInput(const RunRecord& record, Eigen::Index i) {
  std::vector<double> applied;
  double before = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    if (!record.samples[k].has_measurement) continue;
    const double value = record.samples[k].measurement.input_applied[i];
    if (k == 0)
      before = value;
    else
      applied.push_back(value);
  }
  return inputIndices(toVector(applied), before);
}

WindowIndices indicesOfWindow(const RunRecord& record, Eigen::Index i, const ReportWindow& window,
                              double sample_time_h) {
  WindowIndices indices{window, record.info.outputs[static_cast<std::size_t>(i)].name, 0.0, 0.0, 0};
  const double rounding = 1e-6 * sample_time_h;
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const auto& sample = record.samples[k];
    const double time_h = static_cast<double>(k) * sample_time_h;
    if (!sample.has_measurement || !sample.has_tracking) continue;
    if (time_h < window.from_h - rounding || time_h > window.to_h + rounding) continue;
    const double error = sample.measurement.outputs[i] - sample.tracking.setpoint[i];
    indices.mean_error += error;
    indices.rmse += error * error;
    ++indices.samples;
  }
  const auto n = static_cast<double>(indices.samples);
  indices.rmse = std::sqrt(indices.rmse / n);
  indices.mean_error /= n;
  return indices;
}

/// Of the inputs really applied, each held over its sample.
double consumed(const RunRecord& record, const Vector& rate, double sample_time_s) {
  double sum = 0.0;
  for (std::size_t k = 1; k < record.samples.size(); ++k)
    if (record.samples[k].has_measurement)
      sum += rate.dot(record.samples[k].measurement.input_applied) * sample_time_s;
  return sum;
}

double toleranceOf(const InputLimits& limits, Eigen::Index i) {
  const double range = limits.upper[i] - limits.lower[i];
  return kTolerance * (std::isfinite(range) ? range : 1.0);
}

void countInputViolations(const SampleRecord& sample, Summary& summary) {
  const InputLimits& limits = summary.limits;
  for (Eigen::Index i = 0; i < sample.action.input.size(); ++i) {
    const double u = sample.action.input[i];
    const double tolerance = toleranceOf(limits, i);
    const bool inside = u >= limits.lower[i] - tolerance && u <= limits.upper[i] + tolerance;
    summary.input_violations += !inside;
    if (!sample.has_measurement) continue;
    const bool small =
        std::abs(u - sample.measurement.input_applied[i]) <= limits.move[i] + tolerance;
    summary.move_violations += !small;
  }
}

void countOutputViolations(const SampleRecord& sample, Summary& summary) {
  for (Eigen::Index i = 0; i < sample.state.outputs.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double y = sample.state.outputs[i];
    summary.output_violations += !(y >= summary.output_lower[k] && y <= summary.output_upper[k]);
  }
}

/// The value below which the share `p` of the sorted values lies (nearest rank).
double quantile(const std::vector<double>& sorted, double p) {
  if (sorted.empty()) return 0.0;
  const auto rank = static_cast<std::size_t>(std::ceil(p * static_cast<double>(sorted.size())));
  return sorted[std::clamp<std::size_t>(rank, 1, sorted.size()) - 1];
}

/// How many samples at the end of the run have the input at this limit.
std::uint32_t lastAt(const RunRecord& record, Eigen::Index i, double limit, double tolerance) {
  std::uint32_t samples = 0;
  for (auto sample = record.samples.rbegin(); sample != record.samples.rend(); ++sample) {
    if (!sample->has_action) continue;
    if (!(std::abs(sample->action.input[i] - limit) <= tolerance)) break;
    ++samples;
  }
  return samples;
}

void findLockUps(const RunRecord& record, Summary& summary) {
  const std::uint32_t least = std::max<std::uint32_t>(10, summary.steps / 10);
  const InputLimits& limits = summary.limits;
  for (Eigen::Index i = 0; i < limits.lower.size(); ++i)
    for (const bool upper : {false, true}) {
      const double limit = upper ? limits.upper[i] : limits.lower[i];
      const std::uint32_t samples = lastAt(record, i, limit, toleranceOf(limits, i));
      if (samples >= least)
        summary.locked.push_back(
            {summary.input_names[static_cast<std::size_t>(i)], upper, samples});
    }
}

void summarizeSolves(const RunRecord& record, Summary& summary) {
  std::vector<double> microseconds;
  for (const auto& sample : record.samples) {
    if (!sample.has_report || sample.report.status == SolveStatus::kNotRun) continue;
    const SolveStatus status = sample.report.status;
    microseconds.push_back(1e6 * sample.report.seconds);
    if (status == SolveStatus::kInfeasible)
      ++summary.clp_infeasible;
    else if (status != SolveStatus::kSolved && status != SolveStatus::kBoundWins)
      ++summary.clp_failed;
  }
  std::sort(microseconds.begin(), microseconds.end());
  summary.clp_solves = microseconds.size();
  summary.clp_median_us = quantile(microseconds, 0.5);
  summary.clp_p99_us = quantile(microseconds, 0.99);
}

void countSamples(const RunRecord& record, Summary& summary) {
  summary.sources.assign(static_cast<std::size_t>(ActionSource::kFallback) + 1, 0);
  for (const auto& sample : record.samples) {
    if (sample.has_state) {
      summary.actuator_clips += sample.state.actuator_clips;
      countOutputViolations(sample, summary);
    }
    if (!sample.has_action) continue;
    ++summary.steps;
    ++summary.sources[static_cast<std::size_t>(sample.action.source)];
    countInputViolations(sample, summary);
  }
}

/// Counted again from the record; 0 where the record is not at hand (it is the plant's, maybe of
/// another machine).
void countCells(const LoopFile& loop, Summary& summary) {
  if (loop.external_plant || loop.disturbance.source != DisturbanceSource::kCsv) return;
  try {
    const DisturbanceRecord record = makeDisturbance(loop);
    summary.repaired_cells = record.repaired;
    summary.implausible_cells = record.implausible;
  } catch (const InputError&) {  // not on this machine
  }
}

}  // namespace

Summary summarize(const LoopFile& loop, const RunRecord& record, double wall_s) {
  Summary summary;
  summary.loop = loop.name;
  summary.title = loop.report.title;
  summary.complete = record.complete;
  summary.failed_samples = record.failed_samples;
  summary.trouble = record.trouble;
  summary.remarks = record.remarks;
  summary.wall_s = wall_s;
  summary.limits = loop.simulation.actuator.limits;
  summary.output_lower = loop.report.output_lower;
  summary.output_upper = loop.report.output_upper;
  const double sample_time_h = loop.plant_info.sample_time_s / 3600.0;
  for (const auto& output : loop.plant_info.outputs) {
    const auto i = static_cast<Eigen::Index>(summary.output_names.size());
    summary.output_names.push_back(output.name);
    summary.output_units.push_back(output.unit);
    summary.outputs.push_back(indicesOfOutput(record, i, sample_time_h));
    for (const auto& window : loop.report.windows)
      if (window.output.empty() || window.output == output.name)
        summary.windows.push_back(indicesOfWindow(record, i, window, sample_time_h));
  }
  for (const auto& input : loop.plant_info.inputs) {
    summary.inputs.push_back(
        indicesOfInput(record, static_cast<Eigen::Index>(summary.input_names.size())));
    summary.input_names.push_back(input.name);
    summary.input_units.push_back(input.unit);
  }
  for (const auto& [name, rate] : loop.report.consumption)
    summary.consumption.emplace_back(name, consumed(record, rate, loop.plant_info.sample_time_s));
  countSamples(record, summary);
  findLockUps(record, summary);
  summary.outside_model = samplesOutsideModel(loop, record);
  summary.has_clp = loop.has_clp;
  if (loop.has_clp) summarizeSolves(record, summary);
  countCells(loop, summary);
  return summary;
}

}  // namespace fpc
