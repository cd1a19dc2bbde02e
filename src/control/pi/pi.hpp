// PI control, one loop per input: the baseline that must be beaten honestly.
// Source: vallejo2019, section 5.2.2.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "control/pi/pi_terms.hpp"
#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/reference.hpp"

namespace fpc {

/// What keeps the integral from winding up while u is at a limit.
enum class AntiWindup { kNone, kClamp, kTracking };
/// bias: the integral starts at 0; bumpless: u(0) = input_applied.
enum class PiStart { kBias, kBumpless };

inline std::vector<std::string> wordsOf(AntiWindup) { return {"none", "clamp", "tracking"}; }
inline std::vector<std::string> wordsOf(PiStart) { return {"bias", "bumpless"}; }

/// u = bias + kp g e + ki int g e dt, e = setpoint - y. Gains in input units per output unit (and
/// per hour); g = 1 unless scheduled. With `terms` the setpoint may be looked up ahead, filtered
/// and led, and u takes on derivative, feed-forward and the steady input of the setpoint, which g
/// leaves as they are.
struct PiLoop {
  int input{};   ///< index of the input it moves
  int output{};  ///< index of the output it follows
  double kp{};
  double ki_per_h{};
  double bias{};
  bool reverse{false};  ///< e = y - setpoint
  AntiWindup anti_windup{AntiWindup::kClamp};
  double tracking_time_h{};  ///< of `tracking`; 0: kp / ki
  PiStart start{PiStart::kBias};
  std::vector<CurvePoint> gain_schedule;  ///< g(y); empty: 1
  PiTerms terms;
};

/// dt / Tt: share of the clipped part that comes back in a sample, at most 1 (no proportional
/// part).
double trackingShare(const PiLoop& loop, double sample_time_h);

struct PiParams {
  std::vector<PiLoop> loops;
  /// n_y: the published reference is the first-order path to the setpoint with these poles, so that
  /// baselines are judged by the same path; e stays setpoint - y. Empty: the setpoint itself.
  Vector reference_pole;
  /// @throws InputError naming the field: indices, finite gains, words, two loops on one input.
  void validate(Eigen::Index n_y, Eigen::Index n_u, Eigen::Index n_d = 0) const;
};

/// Inputs without a loop stay where they are. The integral uses forward Euler: it is updated after
/// u(k) is computed. A reset in the middle of a run (manual and back, gap) is always bumpless: the
/// integral, or without one (ki = 0) a bias that decays by a tenth per sample, makes the first u
/// equal input_applied.
/// Anti-windup looks at bounds and move limit: `clamp` does not integrate while u is beyond them
/// and the error pushes it further; `tracking` feeds the clipped part back with its time, or with
/// kp / ki.
class PiController final : public Controller {
 public:
  /// @throws InputError naming the field.
  PiController(PiParams params, InputLimits limits, PlantInfo plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  /// Keys kp and ki_per_h, each with a value for the input of every loop.
  Settings settings() const override;
  /// New gains in the next step, without a bump: the integral takes up what the proportional part
  /// gains or loses.
  bool retune(const Settings& settings) override;
  /// "INPUT_integral" of each loop: the integral's share of u, in units of the input.
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }

 private:
  struct LoopState {
    double integral{};   // ki int e dt, in units of the input
    double error{};      // of this sample, times the scheduled gain
    double unclipped{};  // u before the limits
    bool transfer_pending{false};
    double next_kp{}, next_ki_per_h{};  // of the latest retuning
    double aim{};                       // what the error is taken from
    std::optional<PiTermState> terms;   // only where one is on
  };
  void takeSettings(PiLoop& loop, const Measurement& now, LoopState& state) const;
  double errorOf(const PiLoop& loop, const Measurement& now, double aim) const;
  Vector gains(double PiLoop::*gain, double LoopState::*next) const;
  void propose(const PiLoop& loop, const Measurement& now, LoopState& state) const;
  void refer(const SetpointSource& setpoint, std::uint32_t step, Vector& reference);
  void integrate(const PiLoop& loop, const Measurement& now, double sent, LoopState& state) const;

  PiParams params_;
  InputLimits limits_;
  double sample_time_h_;
  std::vector<LoopState> states_;   // one per loop
  std::vector<SignalInfo> inputs_;  // of each loop
  bool retuned_{false};             // gains of the states wait for the next step
  bool running_{false};             // an input has been computed since the reset
  std::optional<ReferenceTrajectory> path_;
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
