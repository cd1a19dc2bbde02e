// Order within a sample: what was applied is recorded, gains are learned from the new outputs, the
// loops are retuned inside the guards, then the PI terms and the decoupling give u(k).
#include "control/pi/adaptive_pi.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/pi/decoupling.hpp"

namespace fpc {
namespace {

constexpr std::array<std::size_t, 2> kLoops{0, 1};

using Gains = std::array<std::array<double, 2>, 2>;

Gains gainsOf(const FopdtMatrix& model) {
  return {{{model[0][0].gain, model[0][1].gain}, {model[1][0].gain, model[1][1].gain}}};
}

double wordOf(bool value) { return value ? 1.0 : 0.0; }

}  // namespace

struct AdaptivePi::State {
  State(const AdaptivePiParams& p, InputLimits l, PlantInfo i)
      : params(p), limits(std::move(l)), plant(std::move(i)), dt(plant.sample_time_s / 60.0) {}

  struct Loop {
    double kp_model{}, ti{};  ///< for the nominal gain
    double kp{};
    double integral{};       ///< int e dt, min
    double next_integral{};  ///< with the present error, unless the limits hold it back
    double error{};
    double rest_input{}, rest_output{};
  };

  AdaptivePiParams params;
  InputLimits limits;
  PlantInfo plant;
  double dt;  // sample time, min
  std::array<Loop, 2> loops;
  std::optional<InvertedDecoupling> decoupling;
  std::vector<GainEstimator> estimators;  // one per loop's output
  Gains in_use{};
  std::array<int, 2> refused{};  // samples, of each output
  std::array<bool, 2> learned{};
  std::array<double, 2> applied{}, unclipped{};  // inputs: from rest; absolute, before the limits
  bool adapting{true}, transfer{false}, started{false};
  int waiting{};     // samples until anything is learned: the lags do not know the past
  int experience{};  // samples learned since the start
  std::vector<std::pair<std::string, double>> signals;
};

AdaptivePi::AdaptivePi(const AdaptivePiParams& params, InputLimits limits, PlantInfo plant) {
  params.validate(static_cast<Eigen::Index>(plant.outputs.size()),
                  static_cast<Eigen::Index>(plant.inputs.size()));
  limits.validate(2);
  state_ = std::make_unique<State>(params, std::move(limits), std::move(plant));
  State& s = *state_;
  s.in_use = gainsOf(params.model);
  if (params.decoupling) s.decoupling.emplace(params.model, s.dt);
  for (const std::size_t i : kLoops) {
    const AdaptiveLoop& loop = params.loops[i];
    s.loops[i].kp = s.loops[i].kp_model = loop.kp;
    s.loops[i].ti = 60.0 * loop.kp / loop.ki_per_h;
    if (params.adaptation.enabled)
      s.estimators.emplace_back(params.model[i], s.dt, params.adaptation.estimator);
  }
  nameSignals();
}

void AdaptivePi::nameSignals() {
  State& s = *state_;
  for (const std::size_t i : kLoops) {
    const auto& output = s.plant.outputs[static_cast<std::size_t>(s.params.loops[i].output)].name;
    for (const std::size_t j : kLoops) {
      const auto& input = s.plant.inputs[static_cast<std::size_t>(s.params.loops[j].input)].name;
      const std::string pair = "_" + output + "_" + input;
      for (const char* what : {"gain", "gain_deviation", "gain_in_use"})
        s.signals.emplace_back(what + pair, 0.0);
    }
    s.signals.emplace_back("kp_" + output, s.loops[i].kp);
    s.signals.emplace_back("learned_" + output, 0.0);
  }
  s.signals.emplace_back("adapting", 0.0);
}

AdaptivePi::~AdaptivePi() = default;

void AdaptivePi::reset(const Measurement& start) {
  State& s = *state_;
  const bool fresh = start.header.step == 0;
  for (const std::size_t i : kLoops) {
    State::Loop& loop = s.loops[i];
    loop.integral = 0.0;
    loop.rest_input = start.input_applied[s.params.loops[i].input];
    loop.rest_output = start.outputs[s.params.loops[i].output];
  }
  if (s.decoupling) s.decoupling->rest(0.0, 0.0);
  for (std::size_t i = 0; i < s.estimators.size(); ++i) {
    s.estimators[i].rest(0.0, 0.0);
    if (fresh) s.estimators[i].restart(s.params.model[i][0].gain, s.params.model[i][1].gain);
  }
  if (fresh) {
    s.in_use = gainsOf(s.params.model);
    for (const std::size_t i : kLoops) s.loops[i].kp = s.loops[i].kp_model;
    if (s.decoupling) s.decoupling->setGains(s.in_use);
    s.experience = 0;
  }
  s.waiting = fresh ? 0 : s.params.adaptation.start_steps;
  s.transfer = !fresh;
  s.started = false;
  s.refused = {};
}

bool AdaptivePi::adapt(bool on) {
  if (state_->estimators.empty()) return false;
  state_->adapting = on;
  return true;
}

void AdaptivePi::learn(const Measurement& now) {
  State& s = *state_;
  s.learned = {};
  if (!s.adapting || s.estimators.empty()) return;
  if (s.waiting > 0) {
    --s.waiting;
    return;
  }
  for (const std::size_t i : kLoops) {
    const int output = s.params.loops[i].output;
    const SignalInfo& range = s.plant.outputs[static_cast<std::size_t>(output)];
    const double y = now.outputs[output];
    if (y < range.lower || y > range.upper) continue;
    s.learned[i] = s.estimators[i].update(y - s.loops[i].rest_output);
  }
  ++s.experience;
}

bool AdaptivePi::plausible(std::size_t output) const {
  const State& s = *state_;
  const double upper = s.params.adaptation.ratio_upper;
  for (const std::size_t j : kLoops) {
    const double ratio = s.estimators[output].gain(j) / s.params.model[output][j].gain;
    if (!(ratio >= 1.0 / upper && ratio <= upper)) return false;
  }
  return true;
}

bool AdaptivePi::certain(std::size_t output) const {
  const State& s = *state_;
  for (const std::size_t j : kLoops) {
    const double ratio = s.estimators[output].gain(j) / s.params.model[output][j].gain;
    if (!(s.estimators[output].deviation(j) <= s.params.adaptation.deviation_upper * ratio))
      return false;
  }
  return true;
}

void AdaptivePi::retune() {
  State& s = *state_;
  const AdaptationParams& guard = s.params.adaptation;
  if (!s.adapting || s.estimators.empty() || s.experience <= guard.start_steps) return;
  for (const std::size_t i : kLoops) {
    if (!s.learned[i]) continue;
    s.refused[i] = plausible(i) ? 0 : s.refused[i] + 1;
    if (s.refused[i] >= guard.refused_steps) {
      s.estimators[i].restart(s.in_use[i][0], s.in_use[i][1]);
      s.refused[i] = 0;
      continue;
    }
    if (s.refused[i] > 0 || !certain(i)) continue;
    for (const std::size_t j : kLoops) {
      const double most = guard.change_upper * std::abs(s.in_use[i][j]);
      s.in_use[i][j] += std::clamp(s.estimators[i].gain(j) - s.in_use[i][j], -most, most);
    }
    s.loops[i].kp = s.loops[i].kp_model * s.params.model[i][i].gain / s.in_use[i][i];
  }
  if (s.decoupling) s.decoupling->setGains(s.in_use);
}

/// Not further the way a limit holds back.
void AdaptivePi::integrate(const ControllerOutput& output) {
  State& s = *state_;
  for (const std::size_t i : kLoops) {
    const double sent = output.input[s.params.loops[i].input];
    State::Loop& loop = s.loops[i];
    const double push = loop.kp * loop.error;
    const bool held_back =
        (s.unclipped[i] > sent && push > 0.0) || (s.unclipped[i] < sent && push < 0.0);
    if (!held_back && std::isfinite(loop.next_integral)) loop.integral = loop.next_integral;
  }
}

void AdaptivePi::observe(const Measurement& now) {
  State& s = *state_;
  for (const std::size_t i : kLoops)
    s.applied[i] = now.input_applied[s.params.loops[i].input] - s.loops[i].rest_input;
  if (s.started) {
    if (s.decoupling) s.decoupling->record(s.applied[0], s.applied[1]);
    for (GainEstimator& estimator : s.estimators) estimator.advance(s.applied[0], s.applied[1]);
  }
  s.started = true;
}

void AdaptivePi::propose(const Measurement& now, const SetpointSource& setpoint) {
  State& s = *state_;
  for (const std::size_t i : kLoops) {
    State::Loop& loop = s.loops[i];
    const int y = s.params.loops[i].output;
    loop.error = setpoint.present()[y] - now.outputs[y];
    loop.next_integral = loop.integral + loop.error * s.dt;
    s.unclipped[i] = loop.kp * (loop.error + loop.next_integral / loop.ti);
  }
  std::array<double, 2> cross{};
  if (s.decoupling) {
    s.decoupling->apply(s.unclipped);
    cross = s.decoupling->cross();
  }
  for (const std::size_t i : kLoops) {
    State::Loop& loop = s.loops[i];
    if (s.transfer) {
      s.unclipped[i] = s.applied[i] + cross[i];
      if (loop.kp != 0.0) loop.next_integral = (s.unclipped[i] / loop.kp - loop.error) * loop.ti;
      loop.integral = loop.next_integral;
    }
    s.unclipped[i] += loop.rest_input - cross[i];
  }
  s.transfer = false;
}

void AdaptivePi::send(const Measurement& now, ControllerOutput& output) {
  State& s = *state_;
  output.begin();
  output.input = now.input_applied;
  output.ok = std::isfinite(s.unclipped[0]) && std::isfinite(s.unclipped[1]);
  if (!output.ok) output.events.add({EventCode::kLawFailed});
  for (const std::size_t i : kLoops)
    if (std::isfinite(s.unclipped[i])) output.input[s.params.loops[i].input] = s.unclipped[i];
  s.limits.clip(output.input, now.input_applied);
  output.source = ActionSource::kBase;
  for (const std::size_t i : kLoops)
    if (output.input[s.params.loops[i].input] != s.unclipped[i])
      output.source = ActionSource::kClipped;
  if (!output.ok) output.source = ActionSource::kHeld;
}

void AdaptivePi::step(const Measurement& now, const SetpointSource& setpoint,
                      ControllerOutput& output) {
  output.reference = setpoint.present();
  observe(now);
  learn(now);
  retune();
  propose(now, setpoint);
  send(now, output);
  integrate(output);
  refreshSignals();
}

void AdaptivePi::refreshSignals() {
  State& s = *state_;
  std::size_t place = 0;
  for (const std::size_t i : kLoops) {
    for (const std::size_t j : kLoops) {
      const bool learns = !s.estimators.empty();
      s.signals[place++].second = learns ? s.estimators[i].gain(j) : s.in_use[i][j];
      s.signals[place++].second = learns ? s.estimators[i].deviation(j) : 0.0;
      s.signals[place++].second = s.in_use[i][j];
    }
    s.signals[place++].second = s.loops[i].kp;
    s.signals[place++].second = wordOf(s.learned[i]);
  }
  s.signals[place].second = wordOf(s.adapting && !s.estimators.empty());
}

const std::vector<std::pair<std::string, double>>& AdaptivePi::signals() const {
  return state_->signals;
}
double AdaptivePi::kp(std::size_t loop) const { return state_->loops[loop].kp; }
double AdaptivePi::gainInUse(std::size_t output, std::size_t input) const {
  return state_->in_use[output][input];
}
const GainEstimator& AdaptivePi::estimator(std::size_t output) const {
  return state_->estimators.at(output);
}

}  // namespace fpc
