// Gains of a running PI controller as texts that a person can type.
#include <cmath>

#include "control/pi/read_pi.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// Of each loop, the latest ones asked for.
Vector PiController::gains(double PiLoop::*gain, double LoopState::*next) const {
  Vector values(static_cast<Eigen::Index>(states_.size()));
  for (std::size_t i = 0; i < states_.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = retuned_ ? states_[i].*next : params_.loops[i].*gain;
  return values;
}

const SettingsTable<PiGains>& piSettings() {
  static const SettingsTable<PiGains> table =
      SettingsTable<PiGains>()
          .ofInputs("kp", &PiGains::kp,
                    "input unit per output unit: 'q_r=2 q_w=1', or '2 1', or one")
          .ofInputs("ki_per_h", &PiGains::ki_per_h,
                    "input unit per output unit and hour, in the same way");
  return table;
}

Settings PiController::settings() const {
  return piSettings().show({gains(&PiLoop::kp, &LoopState::next_kp),
                            gains(&PiLoop::ki_per_h, &LoopState::next_ki_per_h)},
                           {inputs_, inputs_});
}

bool PiController::retune(const Settings& settings) {
  PiGains next{gains(&PiLoop::kp, &LoopState::next_kp),
               gains(&PiLoop::ki_per_h, &LoopState::next_ki_per_h)};
  piSettings().take(settings, {inputs_, inputs_}, next);
  require(next.kp.allFinite(), "controller.loops.kp", "finite numbers");
  require(next.ki_per_h.allFinite(), "controller.loops.ki_per_h", "finite numbers");
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].next_kp = next.kp[static_cast<Eigen::Index>(i)];
    states_[i].next_ki_per_h = next.ki_per_h[static_cast<Eigen::Index>(i)];
  }
  retuned_ = true;
  return true;
}

/// u(k) stays what the old gains make of it: bias + kp' e + I' = bias + kp e + I.
void PiController::takeSettings(PiLoop& loop, const Measurement& now, LoopState& state) const {
  const double change = (loop.kp - state.next_kp) * errorOf(loop, now, state.aim);
  if (running_ && std::isfinite(change)) state.integral += change;
  loop.kp = state.next_kp;
  loop.ki_per_h = state.next_ki_per_h;
}

}  // namespace fpc
