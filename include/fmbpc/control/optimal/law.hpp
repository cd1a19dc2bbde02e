// Fuzzy optimal predictive control: a quadratic law for every rule, blended by firing weights.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/disturbance_observer.hpp"
#include "fmbpc/control/optimal/quadratic_law.hpp"

namespace fpc {

/// What may be changed while the loop runs.
struct FuzzyOptimalTuning {
  int horizon_steps{40};                ///< P
  int move_steps{1};                    ///< M
  QuadraticWeights weight;              ///< of every rule, unless it has its own
  std::vector<QuadraticWeights> rules;  ///< empty, or one for each rule of the model
  Vector input_target;                  ///< n_u, u_t; matters where an input has a weight
  /// @throws InputError naming the field ("controller.weight_move").
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
};

struct FuzzyOptimalParams {
  FuzzyOptimalTuning tuning;
  std::string solve{"together"};      ///< together, or each: see QuadraticHorizon
  std::string disturbance{"inside"};  ///< inside, outside (offset for P > 1) or none (as printed)
  double disturbance_gain{1.0};       ///< (0, 1]: how far d follows the newest error
  bool observe{false};      ///< state and d come from an observer with stated noise; inside only
  ObserverParams observer;  ///< used if observe
  Vector reference_pole;    ///< n_y, a_r
  bool preview{false};      ///< references follow the setpoint schedule over the horizon
  bool disturbance_feedforward{true};
  Vector disturbance_nominal;  ///< n_d, what enters the model instead
  double transfer_decay{0.9};  ///< how fast the bias of a bumpless start decays per sample, [0, 1)
  int prediction_steps{1};     ///< n_c of the predictive_action
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// Rule g predicts from measured outputs and applied inputs
///   y(k+1) = sum a y + sum b u + c + d_g,   d_g = y(k) - y_hat_g(k|k-1),
/// with its own d_g inside the recursion ("inside"): at rest every rule then agrees with the plant,
/// so there is no offset, whatever P, M and the move weights are. With `observe` y(k), the past
/// outputs and d are those of a ModelObserver, which knows how noisy the measurements are. Added to
/// the outputs of the recursion instead ("outside") it leaves an offset for P > 1, as does any
/// weight towards an input target that is not the right one. The input is sum_g w_g u_g (Taieb
/// 2017, eq. 12), w_g the firing weights at the measured antecedents (u(k) replaced by u(k-1)); all
/// outputs must share one premise partition (see splitRules()). Gains are computed when a model or
/// a tuning comes. It takes over in the next step as in FmbpcLaw: the old law still says what u(k)
/// would have been, and the new one starts with a bias that makes its u(k) the very same and fades
/// with transfer_decay; at rest there is none. The measured past is kept if the lags are the same.
/// A start in the middle of a run adds such a bias too. Whatever goes wrong, the last applied input
/// is held, ok is false and remark says why. The prediction is that of the blended model and law.
/// signals(): NAME_error (y - y_hat of the blended rules) of each output and NAME_unclipped of each
/// input.
class FuzzyOptimalLaw final : public Controller {
 public:
  FuzzyOptimalLaw(FuzzyOptimalParams params, InputLimits limits, PlantInfo plant);
  ~FuzzyOptimalLaw() override;

  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool needsModel() const override { return true; }
  /// @throws InputError also for outputs with different partitions, another number of rules than
  /// there are weights, or an input without effect within the horizon and without weight.
  void setModel(const TsModel& model) override;
  /// Whether setModel() would take it, already matched to the plant. @throws InputError as it does.
  static void check(const FuzzyOptimalParams& params, const TsModel& model);
  /// From the next sample on, without a bump. @throws InputError, then nothing changes.
  void retune(FuzzyOptimalTuning tuning);
  const FuzzyOptimalTuning& tuning() const;  ///< the latest
  /// The tuning under the keys of a loop file. Weights and targets: one number for all, one for
  /// each signal, or NAME=number; groups for each rule are separated by semicolons, a single group
  /// is for all rules.
  Settings settings() const override;
  bool retune(const Settings& settings) override;
  const std::vector<std::pair<std::string, double>>& signals() const override;

 private:
  struct Bank;  ///< everything whose size depends on model and tuning
  struct Memory;

  void takeOver(std::unique_ptr<Bank> bank);
  bool think(const Measurement& now, const SetpointSource& setpoint);
  bool handOver(const Measurement& now, const SetpointSource& setpoint);
  void transfer(const Measurement& now);
  void predict(const Measurement& now, const SetpointSource& setpoint,
               PredictiveAction& prediction) const;
  void hold(const Measurement& now, const char* reason, ControllerOutput& output);
  void refreshSignals();

  std::unique_ptr<Memory> memory_;
};

}  // namespace fpc
