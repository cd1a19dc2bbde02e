// Shadow and hand-over under what may go wrong: candidates that are right, candidates whose model
// was spoilt on purpose, and candidates whose law swings, over the plants of examples/handover with
// noise, loads and gains drawn anew for every case.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "config/loop_file.hpp"
#include "config/model_file.hpp"
#include "control/pi/pi.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/factory.hpp"

namespace fpc::bench {

enum class Spoil { kNone, kSign, kDelay, kGain, kUnits, kOther, kSwings };
inline const char* nameOf(Spoil spoil) {
  static constexpr const char* names[] = {"right",
                                          "wrong sign",
                                          "delay off by two",
                                          "gain x 3",
                                          "wrong units",
                                          "model of another plant",
                                          "right model, law that swings"};
  return names[static_cast<std::size_t>(spoil)];
}
inline const std::vector<Spoil>& spoils() {
  static const std::vector<Spoil> all{Spoil::kSign, Spoil::kDelay, Spoil::kGain, Spoil::kUnits,
                                      Spoil::kOther};
  return all;
}

struct StudyPlant {
  const char* name;
  const char* other;  ///< model file of another plant with as many signals
  int settling;       ///< samples
};
inline const std::vector<StudyPlant>& studyPlants() {
  static const std::vector<StudyPlant> all{{"tank", "examples/handover/furnace_model.yaml", 80},
                                           {"column", "config/model/linear_2x2_exact.yaml", 80},
                                           {"reactor", "examples/handover/tank_model.yaml", 80},
                                           {"furnace", "examples/handover/tank_model.yaml", 150}};
  return all;
}

/// What became of one case.
struct CaseResult {
  CandidateState state{};
  bool handed_over{false};
  std::uint32_t handed_at{}, back_at{};  ///< samples; 0: never
  double bump{};                         ///< in allowed moves: from what the former law asked for
  double bump_back{};                    ///< in allowed moves: from the input before
  double after_back{kNaN};  ///< mean square error a settling time later over that of no candidate
  std::string report;
};

/// The input's part of every rule times `factor`; `centred`: about the loop's first input.
inline void scaleInputs(TsModel& model, double factor, const Vector* centre) {
  for (OutputModel& output : model.submodels)
    for (Rule& rule : output.rules)
      for (std::size_t j = 0; j < output.regressors.size(); ++j) {
        const Regressor& regressor = output.regressors[j];
        if (regressor.kind != SignalKind::kInput) continue;
        double& c = rule.coefficients[static_cast<Eigen::Index>(j)];
        if (centre != nullptr) rule.offset += (1.0 - factor) * c * (*centre)[regressor.index];
        c *= factor;
      }
}

inline void shiftInputs(TsModel& model, int samples) {
  for (OutputModel& output : model.submodels)
    for (Regressor& regressor : output.regressors)
      if (regressor.kind == SignalKind::kInput) regressor.lag += samples;
}

/// Whether every input acts at least two samples late, so that it may be taken to act earlier.
inline bool isLate(const TsModel& model) {
  for (const OutputModel& output : model.submodels)
    for (const Regressor& regressor : output.regressors)
      if (regressor.kind == SignalKind::kInput && regressor.lag < 2) return false;
  return true;
}

/// Another plant's rules under this one's names, at rest where this plant is.
inline TsModel otherModel(const TsModel& mine, const std::string& file, const Vector& input,
                          const Vector& rest) {
  TsModel model = mine;
  model.domain = {};
  model.submodels = readModel(file).submodels;
  for (std::size_t o = 0; o < model.submodels.size(); ++o)
    for (Rule& rule : model.submodels[o].rules) {
      rule.offset = rest[static_cast<Eigen::Index>(o)];
      for (std::size_t j = 0; j < model.submodels[o].regressors.size(); ++j) {
        const Regressor& regressor = model.submodels[o].regressors[j];
        const double c = rule.coefficients[static_cast<Eigen::Index>(j)];
        rule.offset -= c * (regressor.kind == SignalKind::kInput ? input[regressor.index]
                                                                 : rest[regressor.index]);
      }
    }
  return model;
}

inline TsModel spoilt(const LoopFile& loop, const LoopFile& candidate, Spoil spoil,
                      const std::string& other, std::mt19937_64& random) {
  TsModel model = candidate.model;
  const Vector& input = loop.simulation.actuator.initial;
  const bool heads = uniform(random) < 0.5;
  if (spoil == Spoil::kSign) scaleInputs(model, -1.0, &input);
  if (spoil == Spoil::kGain) scaleInputs(model, 3.0, &input);
  if (spoil == Spoil::kUnits) scaleInputs(model, heads ? 60.0 : 1.0 / 60.0, nullptr);
  if (spoil == Spoil::kDelay) shiftInputs(model, heads && isLate(model) ? -2 : 2);
  if (spoil == Spoil::kOther) model = otherModel(model, other, input, loop.setpoint.initial);
  return model;
}

/// What happened in one run, and the squares of the errors, sample by sample.
struct CaseRun {
  CaseResult result;
  std::vector<double> errors;
};

/// Largest |a - b| in allowed moves.
inline double distance(const InputLimits& limits, VectorRef a, VectorRef b) {
  return (a - b).cwiseAbs().cwiseQuotient(limits.move).maxCoeff();
}

/// What the law asks for that is not in charge: signals beside_INPUT, before the last one.
inline Vector besideOf(const Controller& law, Eigen::Index n_u) {
  const auto& signals = law.signals();
  const std::size_t first = signals.size() - 1 - static_cast<std::size_t>(n_u);
  Vector input(n_u);
  for (Eigen::Index i = 0; i < n_u; ++i)
    input[i] = signals[first + static_cast<std::size_t>(i)].second;
  return input;
}

inline CaseRun runOnce(const LoopFile& loop, const std::vector<Command>& commands) {
  CaseRun run;
  CaseResult& result = run.result;
  Simulation simulation = makeSimulation(loop);
  simulation.reset(1);
  for (const Command& command : commands) simulation.command(command);
  ControllerSession session = makeControllerSession(loop);
  if (session.controller().needsModel()) session.setModel(loop.model);
  const InputLimits& limits = loop.simulation.actuator.limits;
  const WatchedLaw* watched = session.watched();
  CandidateState before = CandidateState::kNone;
  for (std::uint32_t k = 0; k < loop.simulation.samples; ++k) {
    const Measurement now = simulation.measurement();
    session.receive(now);
    const ControllerAnswer& answer = session.answer();
    run.errors.push_back((now.outputs - answer.tracking.setpoint)
                             .cwiseQuotient(loop.simulation.noise_std)
                             .squaredNorm());
    const Vector input = answer.base.input;
    if (watched != nullptr) {
      const CandidateState state = watched->state();
      if (before == CandidateState::kInCharge && !result.handed_over) {  // the first it drives
        result.handed_over = true;
        result.handed_at = k;
        result.bump = distance(limits, input, besideOf(session.controller(), input.size()));
      }
      if (before == CandidateState::kInCharge && state == CandidateState::kBack) {
        result.back_at = k;
        result.bump_back = distance(limits, input, now.input_applied);
      }
      before = state;
    }
    simulation.advance(input);
  }
  if (watched == nullptr) return run;
  result.state = watched->state();
  result.report = watched->report();
  return run;
}

/// The loop of a case, from its seed alone.
struct Case {
  LoopFile loop;
  std::vector<Command> commands;  ///< gains of the plant
};
inline Case makeCase(const std::string& source, const StudyPlant& plant, Spoil spoil,
                     std::uint64_t seed) {
  const std::string file = source + "/examples/handover/" + plant.name;
  auto random = seededEngine(seed, {20261124});
  const auto between = [&](double lower, double upper) {
    return lower + (upper - lower) * uniform(random);
  };
  Case made;
  LoopFile& loop = made.loop;
  loop = readLoop(file + ".yaml", {{"seed", std::to_string(seed)}});
  // Setpoint steps from a half to one and a half times those of the file, either way.
  const double side = uniform(random) < 0.5 ? -1.0 : 1.0;
  for (SetpointStep& step : loop.setpoint.schedule)
    for (Eigen::Index i = 0; i < step.value.size(); ++i)
      step.value[i] = loop.setpoint.initial[i] +
                      side * between(0.5, 1.5) * (step.value[i] - loop.setpoint.initial[i]);
  LoopFile candidate = readLoop(file + "_candidate.yaml");
  if (spoil == Spoil::kSwings) {  // the PI in charge with ten times its gain, and the right model
    Overrides hot{{"model.file", candidate.model_file}};
    const auto& loops = loop.controllerParams<PiParams>().loops;
    for (std::size_t i = 0; i < loops.size(); ++i)
      hot.emplace_back("controller.loops." + std::to_string(i) + ".kp",
                       exactText(10.0 * loops[i].kp));
    candidate = readLoop(file + ".yaml", hot);
  }
  candidate.model = spoilt(loop, candidate, spoil, source + "/" + plant.other, random);
  loop.candidate.loop = std::make_shared<const LoopFile>(std::move(candidate));
  loop.candidate.params.automatic = true;
  const Simulation simulation = makeSimulation(loop);
  const auto& names = simulation.commandNames();
  for (std::size_t d = 0; d < names.size(); ++d)  // gains of the plant within 15 %
    if (names[d].rfind("gain/", 0) == 0)
      made.commands.push_back({0,
                               {names[d]},
                               {loop.simulation.disturbance_nominal[static_cast<Eigen::Index>(d)] *
                                between(0.85, 1.15)},
                               CommandMode::kOverride});
  return made;
}

inline CaseResult runCase(const std::string& source, const StudyPlant& plant, Spoil spoil,
                          std::uint64_t seed) {
  Case made = makeCase(source, plant, spoil, seed);
  const CaseRun run = runOnce(made.loop, made.commands);
  CaseResult result = run.result;
  if (result.back_at == 0) return result;
  made.loop.candidate.loop = nullptr;
  const CaseRun without = runOnce(made.loop, made.commands);
  const auto settled = static_cast<std::size_t>(plant.settling);
  const auto sum = [&](const std::vector<double>& errors) {
    const std::size_t from = std::min(errors.size(), result.back_at + settled);
    const std::size_t to = std::min(errors.size(), from + settled);
    double squares = 0.0;
    for (std::size_t k = from; k < to; ++k) squares += errors[k];
    return squares;
  };
  result.after_back = sum(run.errors) / sum(without.errors);
  return result;
}

}  // namespace fpc::bench
