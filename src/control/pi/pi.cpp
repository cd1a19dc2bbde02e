#include "control/pi/pi.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kTransferDecay = 0.9;  // per sample, of the bias that replaces a missing integral

// The end of the move limit, or the bound before it.
double insideBounds(const InputLimits& limits, Eigen::Index i, double value) {
  return std::clamp(value, limits.lower[i], limits.upper[i]);
}

void validateLoop(const PiLoop& loop, const std::string& key, Eigen::Index n_y, Eigen::Index n_u,
                  Eigen::Index n_d) {
  require(loop.input >= 0 && loop.input < n_u, key + "input", "one of the plant's inputs");
  require(loop.output >= 0 && loop.output < n_y, key + "output", "one of the plant's outputs");
  require(std::isfinite(loop.kp), key + "kp", "a finite number");
  require(std::isfinite(loop.ki_per_h), key + "ki_per_h", "a finite number");
  require(std::isfinite(loop.bias), key + "bias", "a finite number");
  require(std::isfinite(loop.tracking_time_h) && loop.tracking_time_h >= 0.0,
          key + "tracking_time_h", "a number >= 0");
  validateCurve(loop.gain_schedule, key + "gain_schedule");
  for (const CurvePoint& point : loop.gain_schedule)
    require(point.value > 0.0, key + "gain_schedule", "gains > 0");
  loop.terms.validate(key, n_d);
}

}  // namespace

double trackingShare(const PiLoop& loop, double sample_time_h) {
  const double parts = loop.tracking_time_h > 0.0 ? loop.tracking_time_h : std::abs(loop.kp),
               rate = loop.tracking_time_h > 0.0 ? sample_time_h
                                                 : std::abs(loop.ki_per_h) * sample_time_h;
  return rate < parts ? rate / parts : 1.0;
}

void PiParams::validate(Eigen::Index n_y, Eigen::Index n_u, Eigen::Index n_d) const {
  require(!loops.empty(), "controller.loops", "at least one loop");
  std::set<int> moved;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    const std::string key = "controller.loops[" + std::to_string(i) + "].";
    validateLoop(loops[i], key, n_y, n_u, n_d);
    require(moved.insert(loops[i].input).second, key + "input",
            "an input that no other loop moves");
  }
  if (reference_pole.size() == 0) return;
  require(reference_pole.size() == n_y, "controller.reference_pole",
          std::to_string(n_y) + " numbers");
  require((reference_pole.array() >= 0.0).all() && (reference_pole.array() < 1.0).all(),
          "controller.reference_pole", "numbers >= 0 and < 1");
}

PiController::PiController(PiParams params, InputLimits limits, PlantInfo plant)
    : params_(std::move(params)),
      limits_(std::move(limits)),
      sample_time_h_(plant.sample_time_s / 3600.0),
      states_(params_.loops.size()) {
  const auto n_u = static_cast<Eigen::Index>(plant.inputs.size());
  const auto n_y = static_cast<Eigen::Index>(plant.outputs.size());
  params_.validate(n_y, n_u, static_cast<Eigen::Index>(plant.disturbances.size()));
  limits_.validate(n_u);
  require(std::isfinite(sample_time_h_) && sample_time_h_ > 0.0, "sampling.sample_time_s",
          "a number > 0");
  if (params_.reference_pole.size() > 0) path_.emplace(params_.reference_pole, false);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const PiLoop& loop = params_.loops[i];
    if (loop.terms.any())
      states_[i].terms.emplace(loop.terms, loop.output, n_y, plant.sample_time_s);
  }
  for (const PiLoop& loop : params_.loops)
    inputs_.push_back(plant.inputs[static_cast<std::size_t>(loop.input)]);
  for (const PiLoop& loop : params_.loops)
    signals_.emplace_back(plant.inputs[static_cast<std::size_t>(loop.input)].name + "_integral",
                          0.0);
}

void PiController::reset(const Measurement& start) {
  if (path_) path_->reset(start.outputs);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (retuned_) params_.loops[i].kp = states_[i].next_kp;
    if (retuned_) params_.loops[i].ki_per_h = states_[i].next_ki_per_h;
    LoopState& state = states_[i];
    state.integral = state.error = state.unclipped = state.next_kp = state.next_ki_per_h = 0.0;
    if (state.terms) state.terms->reset();
    const bool from_bias = start.header.step == 0 && params_.loops[i].start == PiStart::kBias;
    states_[i].transfer_pending = !from_bias;
  }
  retuned_ = running_ = false;
}

void PiController::refer(const SetpointSource& setpoint, std::uint32_t step, Vector& reference) {
  reference = path_ ? path_->present() : setpoint.present();
  if (path_) path_->advance(setpoint, step);
}

double PiController::errorOf(const PiLoop& loop, const Measurement& now, double aim) const {
  const double difference = aim - now.outputs[loop.output];
  return (loop.reverse ? -difference : difference) *
         valueOf(loop.gain_schedule, now.outputs[loop.output], 1.0);
}

// u = bias + kp g e + ki int g e dt
void PiController::propose(const PiLoop& loop, const Measurement& now, LoopState& state) const {
  state.error = errorOf(loop, now, state.aim);
  const bool curve = !loop.terms.static_input.empty();
  double proportional = (curve ? 0.0 : loop.bias) + loop.kp * state.error;
  if (state.terms) proportional += state.terms->sum(now, loop.reverse ? -1.0 : 1.0);
  state.unclipped = proportional + state.integral;
  if (!state.transfer_pending || !std::isfinite(proportional)) return;
  state.unclipped = now.input_applied[loop.input];  // not by the sum: free of rounding
  state.integral = state.unclipped - proportional;
  state.transfer_pending = false;
}

void PiController::integrate(const PiLoop& loop, const Measurement& now, double sent,
                             LoopState& state) const {
  if (loop.ki_per_h == 0.0) {
    state.integral *= kTransferDecay;
    return;
  }
  const double before = now.input_applied[loop.input];
  const double move = limits_.move[loop.input];
  double change = loop.ki_per_h * state.error * sample_time_h_;
  if (loop.anti_windup == AntiWindup::kClamp) {
    const bool above = state.unclipped > insideBounds(limits_, loop.input, before + move);
    const bool below = state.unclipped < insideBounds(limits_, loop.input, before - move);
    if ((above && change > 0.0) || (below && change < 0.0)) change = 0.0;
  } else if (loop.anti_windup == AntiWindup::kTracking) {
    change += (sent - state.unclipped) * trackingShare(loop, sample_time_h_);
  }
  const double next = state.integral + change;
  if (std::isfinite(next)) state.integral = next;
}

void PiController::step(const Measurement& now, const SetpointSource& setpoint,
                        ControllerOutput& output) {
  output.begin();
  output.input = now.input_applied;
  refer(setpoint, now.header.step, output.reference);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    LoopState& state = states_[i];
    const Eigen::Index followed = params_.loops[i].output;
    state.aim = state.terms ? state.terms->aim(now, setpoint) : setpoint.present()[followed];
  }
  if (retuned_)
    for (std::size_t i = 0; i < states_.size(); ++i)
      takeSettings(params_.loops[i], now, states_[i]);
  retuned_ = false;
  running_ = true;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    propose(params_.loops[i], now, states_[i]);
    if (std::isfinite(states_[i].unclipped))
      output.input[params_.loops[i].input] = states_[i].unclipped;
    else
      output.ok = false;
  }
  limits_.clip(output.input, now.input_applied);
  output.source = ActionSource::kBase;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const PiLoop& loop = params_.loops[i];
    const double sent = output.input[loop.input];
    if (sent != states_[i].unclipped) output.source = ActionSource::kClipped;
    integrate(loop, now, sent, states_[i]);
    signals_[i].second = states_[i].integral;
  }
  if (output.ok) return;
  output.source = ActionSource::kHeld;
  output.events.add({EventCode::kLawFailed});
}

}  // namespace fpc
