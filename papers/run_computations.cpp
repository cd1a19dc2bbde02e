// Numbers of runs of shipped loops. RUN: papers/runs.hpp; outputs and inputs by name.
#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/performance.hpp"
#include "fmbpc/base/input_error.hpp"
#include "papers/expression.hpp"
#include "papers/runs.hpp"
#include "papers/shortest_step.hpp"
#include "papers/words.hpp"
#include "runtime/run.hpp"
#include "study/evaluate.hpp"

namespace fpc::papers {
namespace {

/// Of an output: name(RUN, OUTPUT).
bool ofOutput(const char* name, double (*what)(const OutputIndices&, const Summary&)) {
  return registerComputation(name, 2, [=](const Words& w) {
    return overRuns(w[0], [&](const RunFigures& run) {
      const Summary& s = run.summary;
      return what(s.outputs[static_cast<std::size_t>(indexOf(s.output_names, w[1], s.loop))], s);
    });
  });
}

/// Of an input: name(RUN, INPUT).
bool ofInput(const char* name, double (*what)(const InputIndices&)) {
  return registerComputation(name, 2, [=](const Words& w) {
    return overRuns(w[0], [&](const RunFigures& run) {
      const Summary& s = run.summary;
      return what(s.inputs[static_cast<std::size_t>(indexOf(s.input_names, w[1], s.loop))]);
    });
  });
}

/// Of the whole run: name(RUN).
bool ofRun(const char* name, double (*what)(const RunFigures&)) {
  return registerComputation(name, 1, [=](const Words& w) { return overRuns(w[0], what); });
}

/// Of the windows of the loop file: name(RUN, WINDOW).
bool ofWindow(const char* name, double (*what)(const WindowIndices&)) {
  return registerComputation(name, 2, [=](const Words& w) {
    return overRuns(
        w[0], [&](const RunFigures& run) { return what(run.summary.windows.at(toIndex(w[1]))); });
  });
}

const bool kSummaries =
    ofOutput("ise", [](const OutputIndices& y, const Summary&) { return y.ise; }) &&
    ofOutput("ise_reference",
             [](const OutputIndices& y, const Summary&) { return y.ise_reference; }) &&
    ofOutput("rmse", [](const OutputIndices& y, const Summary&) { return y.rmse; }) &&
    ofOutput("rms_reference",
             [](const OutputIndices& y, const Summary& s) {
               return std::sqrt(y.ise_reference / (s.steps + 1.0));
             }) &&
    ofInput("least", [](const InputIndices& u) { return u.min; }) &&
    ofInput("largest", [](const InputIndices& u) { return u.max; }) &&
    ofInput("mean_move", [](const InputIndices& u) { return u.mean_abs_move; }) &&
    ofInput("switches", [](const InputIndices& u) { return static_cast<double>(u.switches); }) &&
    ofInput("energy", [](const InputIndices& u) { return u.energy; }) &&
    ofRun("consumption", [](const RunFigures& r) { return r.summary.consumption.at(0).second; }) &&
    ofRun("active", [](const RunFigures& r) { return r.active; }) &&
    ofRun("locked",
          [](const RunFigures& r) {
            return contains(r.summary.events, EventCode::kInputAtLimit) ? 1.0 : 0.0;
          }) &&
    ofRun("broken",
          [](const RunFigures& r) {
            const Summary& s = r.summary;
            return static_cast<double>(s.input_violations + s.move_violations + s.clp_infeasible +
                                       s.clp_failed);
          }) &&
    ofWindow("window_rmse", [](const WindowIndices& w) { return w.rmse; }) &&
    ofWindow("window_error", [](const WindowIndices& w) { return w.mean_error; });

double at(const Vector& values, Eigen::Index i) {
  return i < values.size() ? values[i] : kNotPrinted;
}

using OfSample = std::function<double(const SampleRecord&)>;

/// Outputs and disturbances as they are measured, inputs as they are applied, `true/NAME` without
/// noise.
OfSample reader(const RunRecord& run, std::string signal) {
  const auto index = [&](const auto& signals) { return indexOf(signals, signal, run.loop); };
  const auto has = [&](const std::vector<SignalInfo>& signals) {
    return std::any_of(signals.begin(), signals.end(),
                       [&](const SignalInfo& s) { return s.name == signal; });
  };
  const bool clean = signal.rfind("true/", 0) == 0;
  if (clean) signal = signal.substr(5);
  if (clean)
    return [i = index(run.info.outputs)](const SampleRecord& k) { return at(k.state.outputs, i); };
  if (has(run.info.outputs))
    return [i = index(run.info.outputs)](const SampleRecord& k) {
      return at(k.measurement.outputs, i);
    };
  if (has(run.info.inputs))
    return [i = index(run.info.inputs)](const SampleRecord& k) {
      return at(k.measurement.input_applied, i);
    };
  return [i = index(run.info.disturbances)](const SampleRecord& k) {
    return at(k.measurement.disturbances, i);
  };
}

std::size_t stepOf(const RunRecord& run, const std::string& word) {
  return word == "end" ? run.samples.size() - 1 : toIndex(word);
}

/// trajectory(RUN, SIGNAL): every sample.
Values trajectory(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const OfSample value = reader(run, w[1]);
  std::vector<double> all;
  for (const auto& sample : run.samples) all.push_back(value(sample));
  return all;
}

/// last_input(RUN, INPUT): of the last action; the final sample has none.
Values lastInput(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const Vector& u = run.samples.at(run.samples.size() - 2).action.input;
  return u[indexOf(run.info.inputs, w[1], run.loop)];
}

/// error(RUN, SIGNAL, FROM, TO): signal - setpoint of the samples from..to; `true/NAME` likewise.
Values errors(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const OfSample value = reader(run, w[1]);
  const std::string output = w[1].rfind("true/", 0) == 0 ? w[1].substr(5) : w[1];
  const Eigen::Index i = indexOf(run.info.outputs, output, run.loop);
  std::vector<double> all;
  for (std::size_t k = stepOf(run, w[2]); k <= stepOf(run, w[3]); ++k)
    all.push_back(value(run.samples.at(k)) - run.samples.at(k).tracking.setpoint[i]);
  return all;
}

/// relative_error(RUN, OUTPUT): error / setpoint of every sample.
Values relativeErrors(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const Eigen::Index i = indexOf(run.info.outputs, w[1], run.loop);
  std::vector<double> all;
  for (const auto& sample : run.samples)
    all.push_back(sample.measurement.outputs[i] / sample.tracking.setpoint[i] - 1.0);
  return all;
}

/// integral(RUN, OUTPUT, INDEX, FROM, TO): IAE, ITAE, ISE or ITSE over samples, time in minutes.
Values integral(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const Eigen::Index output = indexOf(run.info.outputs, w[1], run.loop);
  const bool timed = w[2] == "ITAE" || w[2] == "ITSE", square = w[2] == "ISE" || w[2] == "ITSE";
  require(timed || square || w[2] == "IAE", w[2], "IAE, ITAE, ISE or ITSE");
  const double dt = run.info.sample_time_s / 60.0;
  double sum = 0.0;
  for (std::size_t k = stepOf(run, w[3]); k <= stepOf(run, w[4]); ++k) {
    const SampleRecord& sample = run.samples.at(k);
    const double e = sample.tracking.setpoint[output] - sample.measurement.outputs[output];
    sum += (timed ? dt * static_cast<double>(k) : 1.0) * (square ? e * e : std::abs(e)) * dt;
  }
  return sum;
}

std::vector<StepIndices> stepsOf(const std::string& name, const std::string& output,
                                 double unit_s) {
  const RunRecord& run = recordOf(name);
  const Eigen::Index i = indexOf(run.info.outputs, output, run.loop);
  Vector y(static_cast<Eigen::Index>(run.samples.size())), setpoint(y.size());
  for (Eigen::Index k = 0; k < y.size(); ++k) {
    const SampleRecord& sample = run.samples[static_cast<std::size_t>(k)];
    y[k] = sample.measurement.outputs[i];
    setpoint[k] = sample.tracking.setpoint[i];
  }
  auto steps = stepIndices(y, setpoint, run.info.sample_time_s / unit_s);
  require(!steps.empty(), name, "at least one step of the setpoint");
  return steps;
}

/// steps(RUN, OUTPUT, INDEX, UNIT_S): an index of every step of the setpoint, times in units of so
/// many seconds.
Values steps(const Words& w) {
  static const std::map<std::string, double (*)(const StepIndices&)> known{
      {"rise", [](const StepIndices& s) { return s.rise; }},
      {"settling", [](const StepIndices& s) { return s.settling; }},
      {"overshoot", [](const StepIndices& s) { return s.overshoot; }},
      {"offset", [](const StepIndices& s) { return s.offset; }},
      {"size", [](const StepIndices& s) { return s.to - s.from; }},
      {"cost", [](const StepIndices& s) { return s.cost(); }}};
  const auto what = known.find(w[2]);
  require(what != known.end(), w[2], "rise, settling, overshoot, offset, size or cost");
  std::vector<double> all;
  for (const StepIndices& step : stepsOf(w[0], w[1], toNumber(w[3])))
    all.push_back(what->second(step));
  return all;
}

/// first(RUN, OUTPUT, INDEX, UNIT_S): of the first step.
Values firstStep(const Words& w) { return steps(w).all().front(); }

/// relative_energy(RUN): of all inputs, each in shares of the input at the start.
Values relativeEnergy(const Words& w) {
  const RunRecord& run = recordOf(w[0]);
  const Vector first = run.samples.front().measurement.input_applied;
  double sum = 0.0;
  for (const SampleRecord& sample : run.samples)
    sum += sample.measurement.input_applied.cwiseQuotient(first).squaredNorm();
  return sum;
}

/// least_rise(RUN, LEVEL, OVERSHOOT): the shortest rise time that the actuator allows [s].
Values leastRise(const Words& w) {
  return shortestStep(loopOf(w[0]), toNumber(w[1]), toNumber(w[2])).rise_s;
}

/// effluent(RUN, INDEX): of BSM1; TN.share, TN.95 and so on of a limit.
Values effluent(const Words& w) {
  static std::map<std::string, EffluentReport> done;
  auto known = done.find(w[0]);
  if (known == done.end())
    known = done.emplace(w[0], evaluateEffluent(trajectoryOf(loopOf(w[0]), runLoop(loopOf(w[0])))))
                .first;
  const EffluentReport& r = known->second;
  const auto dot = w[1].find('.');
  if (dot != std::string::npos) {
    const LimitIndices& limit = r.limit(w[1].substr(0, dot));
    return w[1].substr(dot) == ".share" ? limit.share_percent : limit.percentile_95;
  }
  const std::map<std::string, double> all{{"EQI", r.EQI}, {"IQI", r.IQI}, {"AE", r.AE},
                                          {"PE", r.PE},   {"SP", r.SP},   {"OCI", r.OCI}};
  const auto at = all.find(w[1]);
  require(at != all.end(), w[1], "an index of the effluent");
  return at->second;
}

/// coefficient(LOOP, OUTPUT, RULE, TERM): of the loop's model; a term past the last: the offset.
Values coefficient(const Words& w) {
  const TsModel model = readLoop(w[0]).model;
  const Rule& rule = model.submodels.at(toIndex(w[1])).rules.at(toIndex(w[2]));
  const auto term = static_cast<Eigen::Index>(toNumber(w[3]));
  return term < rule.coefficients.size() ? rule.coefficients[term] : rule.offset;
}

/// centre(LOOP, RULE): of the first variable's set; `last` is a rule as well.
Values centre(const Words& w) {
  const OutputModel model = readLoop(w[0]).model.submodels.at(0);
  const Rule& rule = w[1] == "last" ? model.rules.back() : model.rules.at(toIndex(w[1]));
  return rule.antecedents.at(0).parameters.at(0);
}

const bool kRegistered =
    registerComputation("trajectory", 2, trajectory) &&
    registerComputation("last_input", 2, lastInput) && registerComputation("error", 4, errors) &&
    registerComputation("relative_error", 2, relativeErrors) &&
    registerComputation("integral", 5, integral) && registerComputation("steps", 4, steps) &&
    registerComputation("first", 4, firstStep) &&
    registerComputation("relative_energy", 1, relativeEnergy) &&
    registerComputation("least_rise", 3, leastRise) &&
    registerComputation("effluent", 2, effluent) &&
    registerComputation("coefficient", 4, coefficient) && registerComputation("centre", 2, centre);

}  // namespace
}  // namespace fpc::papers
