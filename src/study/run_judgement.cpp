#include "study/run_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/report.hpp"
#include "study/fitness.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kAtBound = 1e-6;       // of an input's range
constexpr double kLockedError = 0.004;  // of the range, below which an output is where it should be

/// -1: at the lower bound, 1: at the upper one, 0: between them.
int boundOf(const InputLimits& limits, const Vector& input, Index i) {
  const double range = limits.upper[i] - limits.lower[i];
  if (!std::isfinite(range) || range <= 0.0) return 0;
  if (input[i] <= limits.lower[i] + kAtBound * range) return -1;
  return input[i] >= limits.upper[i] - kAtBound * range ? 1 : 0;
}

double errorOf(const SampleRecord& sample, Index output) {
  return std::abs(sample.tracking.setpoint[output] - sample.measurement.outputs[output]);
}

/// Mean |error| over samples [first, last).
double meanError(const RunRecord& record, Index output, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t k = first; k < last; ++k) sum += errorOf(record.samples[k], output);
  return sum / static_cast<double>(last - first);
}

bool everMoved(const RunRecord& record, Index i) {
  const SampleRecord* first = nullptr;
  for (const SampleRecord& sample : record.samples) {
    if (!sample.has_measurement) continue;
    if (!first) first = &sample;
    if (sample.measurement.input_applied[i] != first->measurement.input_applied[i]) return true;
  }
  return false;
}

bool lockedOver(const std::vector<SignalInfo>& outputs, const RunRecord& record, std::size_t first,
                std::size_t last) {
  const std::size_t quarter = std::max<std::size_t>(1, (last - first) / 4);
  const auto& setpoint = record.samples[last - 1].tracking.setpoint;
  for (Index i = 0; i < setpoint.size(); ++i) {
    const double begin = meanError(record, i, first, first + quarter);
    const double end = meanError(record, i, last - quarter, last);
    const SignalInfo& output = outputs[static_cast<std::size_t>(i)];
    if (end >= begin && end > kLockedError * (output.upper - output.lower)) return true;
  }
  return false;
}

double meanMove(const Summary& summary) {
  double sum = 0.0;
  for (std::size_t i = 0; i < summary.inputs.size(); ++i) {
    const auto k = static_cast<Index>(i);
    const double range = summary.limits.upper[k] - summary.limits.lower[k];
    sum += summary.inputs[i].mean_abs_move / (std::isfinite(range) && range > 0.0 ? range : 1.0);
  }
  return sum;
}

double largestMove(const RunRecord& record) {
  double largest = 0.0;
  for (std::size_t k = 1; k < record.samples.size(); ++k) {
    const Vector& now = record.samples[k].measurement.input_applied;
    const Vector& before = record.samples[k - 1].measurement.input_applied;
    if (now.size() > 0 && now.size() == before.size())
      largest = std::max(largest, (now - before).cwiseAbs().maxCoeff());
  }
  return largest;
}

/// The output that the study judges first; without one the plant's first.
std::size_t judgedOutput(const StudyFile& study, const LoopFile& loop) {
  const auto& outputs = loop.plant_info.outputs;
  for (const FitnessTerm& term : study.fitness.terms)
    for (std::size_t i = 0; i < outputs.size(); ++i)
      if (outputs[i].name == term.signal) return i;
  return 0;
}

double leastOutput(const RunRecord& record, std::size_t output) {
  double least = kInfinity;
  for (const auto& sample : record.samples)
    if (sample.measurement.outputs.size() > static_cast<Index>(output))
      least = std::min(least, sample.measurement.outputs[static_cast<Index>(output)]);
  return least;
}

/// FNV-1a over the words of the numbers.
std::uint64_t trajectoryHash(const RunRecord& record) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const auto& sample : record.samples)
    for (const Vector* values :
         {&sample.measurement.outputs, &sample.measurement.disturbances,
          &sample.measurement.input_applied, &sample.state.outputs, &sample.state.disturbances})
      for (const double value : *values) {
        std::uint64_t word = 0;
        std::memcpy(&word, &value, sizeof word);
        hash = (hash ^ word) * 1099511628211ULL;
      }
  return hash;
}

/// Why a run has no cost.
std::string reasonOf(const RunRecord& record) {
  if (!record.trouble.empty()) return record.trouble;
  return record.complete ? "the cost is not finite" : "the run ended early";
}

}  // namespace

const char* wordOf(RunFailure failure) {
  switch (failure) {
    case RunFailure::kDiverged:
      return "diverged";
    case RunFailure::kLocked:
      return "locked";
    case RunFailure::kViolated:
      return "violated";
    case RunFailure::kHeld:
      return "held";
    case RunFailure::kOutOfModel:
      break;
  }
  return "out_of_model";
}

RunRecord withoutNoise(RunRecord record) {
  for (auto& sample : record.samples)
    if (sample.has_state && sample.has_measurement)
      sample.measurement.outputs = sample.state.outputs;
  return record;
}

std::uint64_t lockedSamples(const LoopFile& loop, const RunRecord& record, int locked_samples) {
  const InputLimits& limits = loop.simulation.actuator.limits;
  const std::size_t n = record.samples.size();
  const std::size_t enough = locked_samples > 0 ? static_cast<std::size_t>(locked_samples)
                                                : std::max<std::size_t>(20, n / 10);
  std::size_t longest = 0;
  for (Index i = 0; i < limits.lower.size(); ++i) {
    if (!everMoved(record, i)) continue;
    std::size_t first = 0;
    int bound = 0;
    for (std::size_t k = 0; k <= n; ++k) {
      const bool there =
          k < n && record.samples[k].has_measurement && record.samples[k].has_tracking;
      const int now = there ? boundOf(limits, record.samples[k].measurement.input_applied, i) : 0;
      if (k < n && now == bound) continue;
      const std::size_t length = k - first;
      if (bound != 0 && length >= enough && length > longest &&
          lockedOver(loop.plant_info.outputs, record, first, k))
        longest = length;
      bound = now;
      first = k;
    }
  }
  return longest;
}

RunJudgement judgeRun(const StudyFile& study, const LoopFile& loop, RunRecord record) {
  const std::uint64_t outside_model = samplesOutsideModel(loop, record);  // as the law saw it
  RunJudgement judged;
  judged.trajectory = trajectoryHash(record);
  if (study.noise_free) record = withoutNoise(std::move(record));
  const Summary summary = summarize(loop, record, 0.0);
  const auto note = [&](RunFailure kind) -> std::uint64_t& {
    return judged.failures[static_cast<std::size_t>(kind)];
  };
  judged.cost = fitness(study.fitness, loop, record);
  judged.move = meanMove(summary);
  judged.least = leastOutput(record, judgedOutput(study, loop));
  judged.largest_move = largestMove(record);
  if (!std::isfinite(judged.cost)) {
    note(RunFailure::kDiverged) = record.samples.size();
    judged.trouble = reasonOf(record);
  }
  note(RunFailure::kLocked) = lockedSamples(loop, record, study.locked_samples);
  note(RunFailure::kViolated) =
      summary.input_violations + summary.move_violations + summary.output_violations;
  note(RunFailure::kHeld) = summary.sources[static_cast<std::size_t>(ActionSource::kHeld)];
  note(RunFailure::kOutOfModel) = outside_model;
  return judged;
}

}  // namespace fpc
