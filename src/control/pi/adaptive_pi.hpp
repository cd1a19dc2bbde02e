// Two PI loops behind an inverted decoupling, retuned from gains that are learned on line, inside
// guards. With adaptation off: the decentralised PI of mekki, made measurable.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/fopdt.hpp"
#include "control/pi/gain_estimator.hpp"
#include "fmbpc/control/controller.hpp"

namespace fpc {

/// u = rest + kp (e + (1/Ti) int e dt) - what the decoupling takes out, e = setpoint - y. The
/// integral counts the present error (backward Euler).
struct AdaptiveLoop {
  int input{}, output{};
  double kp{};        ///< input units per output unit
  double ki_per_h{};  ///< kp / Ti, of the same sign
};

/// When, and how far, the loops may be retuned.
struct AdaptationParams {
  bool enabled{false};
  GainEstimatorParams estimator;
  int start_steps{60};       ///< samples of learning after a start before anything is retuned
  double change_upper{0.1};  ///< largest relative change of a gain in use per sample
  double ratio_upper{2.0};   ///< > 1: gains beyond nominal / ratio .. nominal * ratio are refused
  double deviation_upper{0.1};  ///< gains less certain than this (relative) are refused
  int refused_steps{60};        ///< beyond that range for so long: the estimator starts again at
                                ///< the last good gains
  void validate() const;        ///< @throws InputError naming the field
};

struct AdaptivePiParams {
  std::array<AdaptiveLoop, 2> loops;
  FopdtMatrix model{};  ///< [loop of the output][loop of the input], minutes
  bool decoupling{true};
  AdaptationParams adaptation;
  /// @throws InputError naming the field.
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
};

/// The loops rest at the outputs and inputs of the first sample. Since the steady input goes with
/// 1/K, a retuning scales kp and with it the integral: kp_i = kp_i0 K_ii / Khat_ii (which is what
/// IMC and the swarm give too, when only gains change). Dead times and lags are those of the model.
/// Outputs outside the plant's own ranges teach nothing. Inputs: clamped as in PiController.
/// signals(): gain_OUTPUT_INPUT, its deviation, what is in use, kp of each loop, adapting, learned.
class AdaptivePi final : public Controller {
 public:
  /// @throws InputError naming the field, also when the model cannot be decoupled.
  AdaptivePi(const AdaptivePiParams& params, InputLimits limits, PlantInfo plant);
  ~AdaptivePi() override;
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool adapt(bool on) override;  ///< false freezes gains and tuning; what was learned stays
  const std::vector<std::pair<std::string, double>>& signals() const override;

  double kp(std::size_t loop) const;
  double gainInUse(std::size_t output, std::size_t input) const;
  const GainEstimator& estimator(std::size_t output) const;

 private:
  struct State;
  void learn(const Measurement& now);
  void retune();
  bool plausible(std::size_t output) const;
  bool certain(std::size_t output) const;
  void observe(const Measurement& now);
  void propose(const Measurement& now, const SetpointSource& setpoint);
  void send(const Measurement& now, ControllerOutput& output);
  void integrate(const ControllerOutput& output);
  void nameSignals();
  void refreshSignals();
  std::unique_ptr<State> state_;
};

}  // namespace fpc
