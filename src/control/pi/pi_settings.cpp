// Gains of a running PI controller as texts that a person can type.
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "fmbpc/control/pi/pi.hpp"

namespace fpc {

/// Of each loop, the latest ones asked for.
Vector PiController::gains(double PiLoop::*gain, double LoopState::*next) const {
  Vector values(static_cast<Eigen::Index>(states_.size()));
  for (std::size_t i = 0; i < states_.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = retuned_ ? states_[i].*next : params_.loops[i].*gain;
  return values;
}

Settings PiController::settings() const {
  return {
      {"kp", signalValuesText(gains(&PiLoop::kp, &LoopState::next_kp), inputs_)},
      {"ki_per_h", signalValuesText(gains(&PiLoop::ki_per_h, &LoopState::next_ki_per_h), inputs_)}};
}

bool PiController::retune(const Settings& settings) {
  Vector kp = gains(&PiLoop::kp, &LoopState::next_kp);
  Vector ki = gains(&PiLoop::ki_per_h, &LoopState::next_ki_per_h);
  for (const auto& [key, text] : settings) {
    const std::string where = "controller." + key;
    require(key == "kp" || key == "ki_per_h", where, "a setting that may change in a run");
    Vector& values = key == "kp" ? kp : ki;
    readSignalValues(text, inputs_, where, values);
    require(values.allFinite(), where, "finite numbers");
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].next_kp = kp[static_cast<Eigen::Index>(i)];
    states_[i].next_ki_per_h = ki[static_cast<Eigen::Index>(i)];
  }
  retuned_ = true;
  return true;
}

/// u(k) stays what the old gains make of it: bias + kp' e + I' = bias + kp e + I.
void PiController::takeSettings(PiLoop& loop, const Measurement& now,
                                const SetpointSource& setpoint, LoopState& state) const {
  const double change = (loop.kp - state.next_kp) * errorOf(loop, now, setpoint, state.aim);
  if (running_ && std::isfinite(change)) state.integral += change;
  loop.kp = state.next_kp;
  loop.ki_per_h = state.next_ki_per_h;
}

}  // namespace fpc
