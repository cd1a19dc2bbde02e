#include "study/fitness.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "base/time_unit.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/recorder_session.hpp"
#include "runtime/report.hpp"
#include "study/evaluate.hpp"

namespace fpc {
namespace {

using OfOutput = double OutputIndices::*;
using OfStep = std::function<double(const StepIndices&)>;
using OfInput = std::function<double(const InputIndices&)>;
using OfRun = std::function<double(const Summary&)>;
using OfEffluent = std::function<double(const EffluentReport&)>;

const std::map<std::string, OfOutput>& outputTable() {
  static const std::map<std::string, OfOutput> table{
      {"ise", &OutputIndices::ise},   {"iae", &OutputIndices::iae},
      {"itae", &OutputIndices::itae}, {"itse", &OutputIndices::itse},
      {"rmse", &OutputIndices::rmse}, {"ise_reference", &OutputIndices::ise_reference}};
  return table;
}

const std::map<std::string, OfStep>& stepTable() {
  static const std::map<std::string, OfStep> table{
      {"rise", [](const StepIndices& s) { return s.rise; }},
      {"settling", [](const StepIndices& s) { return s.settling; }},
      {"overshoot", [](const StepIndices& s) { return s.overshoot; }},
      {"offset", [](const StepIndices& s) { return s.offset; }},
      {"step_cost", [](const StepIndices& s) { return s.cost(); }}};
  return table;
}

const std::map<std::string, OfInput>& inputTable() {
  static const std::map<std::string, OfInput> table{
      {"travel", [](const InputIndices& u) { return u.travel; }},
      {"mean_abs_move", [](const InputIndices& u) { return u.mean_abs_move; }},
      {"switches", [](const InputIndices& u) { return static_cast<double>(u.switches); }},
      {"effort", [](const InputIndices& u) { return u.effort; }},
      {"energy", [](const InputIndices& u) { return u.energy; }}};
  return table;
}

double count(std::uint64_t n) { return static_cast<double>(n); }

const std::map<std::string, OfRun>& runTable() {
  static const std::map<std::string, OfRun> table{
      {"violations",
       [](const Summary& s) {
         return count(s.input_violations + s.move_violations + s.output_violations);
       }},
      {"input_violations", [](const Summary& s) { return count(s.input_violations); }},
      {"move_violations", [](const Summary& s) { return count(s.move_violations); }},
      {"output_violations", [](const Summary& s) { return count(s.output_violations); }},
      {"actuator_clips", [](const Summary& s) { return count(s.actuator_clips); }},
      {"clp_infeasible", [](const Summary& s) { return count(s.clp_infeasible); }}};
  return table;
}

const std::map<std::string, OfEffluent>& effluentTable() {
  static const std::map<std::string, OfEffluent> table{
      {"AE", [](const EffluentReport& r) { return r.AE; }},
      {"EQI", [](const EffluentReport& r) { return r.EQI; }},
      {"OCI", [](const EffluentReport& r) { return r.OCI; }},
      {"PE", [](const EffluentReport& r) { return r.PE; }},
      {"SP", [](const EffluentReport& r) { return r.SP; }},
      {"NH_95", [](const EffluentReport& r) { return r.limit("NH").percentile_95; }},
      {"NH_share", [](const EffluentReport& r) { return r.limit("NH").share_percent; }},
      {"TN_95", [](const EffluentReport& r) { return r.limit("TN").percentile_95; }},
      {"TN_share", [](const EffluentReport& r) { return r.limit("TN").share_percent; }},
      {"TSS_share", [](const EffluentReport& r) { return r.limit("TSS").share_percent; }}};
  return table;
}

bool hasSetpoint(const LoopFile& loop, std::size_t output) {
  const auto& without = loop.report.without_setpoint;
  return std::find(without.begin(), without.end(), static_cast<Eigen::Index>(output)) ==
         without.end();
}

/// All steps of output i.
std::vector<StepIndices> stepsOf(const FitnessParams& fitness, const LoopFile& loop,
                                 const RunRecord& record, Eigen::Index i) {
  const auto n = static_cast<Eigen::Index>(record.samples.size());
  Vector y(n), setpoint(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const SampleRecord& sample = record.samples[static_cast<std::size_t>(k)];
    y[k] = sample.measurement.outputs[i];
    setpoint[k] = sample.tracking.setpoint[i];
  }
  return stepIndices(y, setpoint, loop.plant_info.sample_time_s / secondsPer(fitness.time_unit),
                     fitness.band);
}

double sumOf(const FitnessParams& fitness, const FitnessTerm& term, const LoopFile& loop,
             const RunRecord& record, const Summary& summary) {
  const auto meant = [&](const std::string& name) {
    return term.signal.empty() || term.signal == name;
  };
  const auto judged = [&](std::size_t i) {
    return hasSetpoint(loop, i) && meant(summary.output_names[i]);
  };
  double sum = 0.0;
  std::size_t steps = 0;
  switch (kindOf(term.index)) {
    case IndexOf::kOutput:
      for (std::size_t i = 0; i < summary.outputs.size(); ++i)
        if (judged(i)) sum += summary.outputs[i].*outputTable().at(term.index);
      return sum;
    case IndexOf::kStep:
      for (std::size_t i = 0; i < summary.output_names.size(); ++i) {
        if (!judged(i)) continue;
        for (const auto& step : stepsOf(fitness, loop, record, static_cast<Eigen::Index>(i))) {
          sum += stepTable().at(term.index)(step);
          ++steps;
        }
      }
      return sum / static_cast<double>(steps);
    case IndexOf::kInput:
      for (std::size_t i = 0; i < summary.inputs.size(); ++i)
        if (meant(summary.input_names[i])) sum += inputTable().at(term.index)(summary.inputs[i]);
      return sum;
    case IndexOf::kConsumption:
      for (const auto& [name, value] : summary.consumption)
        if (meant(name)) sum += value;
      return sum;
    case IndexOf::kEffluent:
    case IndexOf::kRun:
      break;
  }
  return runTable().at(term.index)(summary);
}

/// What a term may name; of outputs those that are asked something of.
std::vector<std::string> signalsOf(const FitnessTerm& term, const LoopFile& loop) {
  std::vector<std::string> names;
  const IndexOf kind = kindOf(term.index);
  if (kind == IndexOf::kOutput || kind == IndexOf::kStep)
    for (std::size_t i = 0; i < loop.plant_info.outputs.size(); ++i)
      if (hasSetpoint(loop, i)) names.push_back(loop.plant_info.outputs[i].name);
  if (kind == IndexOf::kInput)
    for (const auto& input : loop.plant_info.inputs) names.push_back(input.name);
  if (kind == IndexOf::kConsumption)
    for (const auto& consumption : loop.report.consumption) names.push_back(consumption.name);
  return names;
}

/// The plants of BSM1 are known by what they name.
bool hasEffluent(const LoopFile& loop) {
  const auto columns = trajectoryOf(loop, recordLayout(loop).emptyRecord()).names;
  return std::find(columns.begin(), columns.end(), "TSS_L1") != columns.end();
}

/// What counts of a term: all of it, or what is above its threshold.
double counted(const FitnessTerm& term, double value) {
  return std::isinf(term.above) ? value : std::max(0.0, value - term.above);
}

}  // namespace

void checkFitness(const FitnessParams& fitness, const LoopFile& loop) {
  for (std::size_t t = 0; t < fitness.terms.size(); ++t) {
    const FitnessTerm& term = fitness.terms[t];
    const std::string where = "fitness.terms[" + std::to_string(t) + "]";
    const auto names = signalsOf(term, loop);
    const bool known = std::find(names.begin(), names.end(), term.signal) != names.end();
    if (kindOf(term.index) == IndexOf::kRun) continue;
    if (kindOf(term.index) == IndexOf::kEffluent) {
      require(hasEffluent(loop), where, "a loop with a plant of BSM1: " + loop.name);
      continue;
    }
    require(!names.empty(), where, "a loop that has what " + term.index + " is of: " + loop.name);
    require(term.signal.empty() || known, where,
            "one of " + join(names) + " of loop " + loop.name + ", got '" + term.signal + "'");
  }
}

double fitness(const FitnessParams& fitness, const LoopFile& loop, const RunRecord& record) {
  if (!record.complete) return kInfinity;
  const Summary summary = summarize(loop, record, 0.0);
  std::optional<EffluentReport> effluent;
  double sum = 0.0;
  for (const auto& term : fitness.terms) {
    if (kindOf(term.index) != IndexOf::kEffluent) {
      sum += term.weight * counted(term, sumOf(fitness, term, loop, record, summary));
      continue;
    }
    if (!effluent) effluent = evaluateEffluent(trajectoryOf(loop, record));
    sum += term.weight * counted(term, effluentTable().at(term.index)(*effluent));
  }
  return std::isfinite(sum) ? sum : kInfinity;
}

}  // namespace fpc
