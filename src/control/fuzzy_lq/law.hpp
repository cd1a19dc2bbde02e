// Fuzzy optimal predictive control: a quadratic law for every rule, blended by firing weights.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "control/fuzzy_lq/quadratic_law.hpp"
#include "estimation/disturbance_observer.hpp"
#include "fmbpc/control/predictive_law.hpp"
#include "fmbpc/control/settings_table.hpp"

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

/// How the moves of an input are found: with those of the others, or each by itself. See
/// QuadraticHorizon.
enum class FuzzyOptimalSolve { kTogether, kEach };
/// Where the disturbance estimate acts: inside the recursion, on its outputs (an offset for P > 1),
/// or nowhere, as printed.
enum class FuzzyOptimalDisturbance { kInside, kOutside, kNone };

inline std::vector<std::string> wordsOf(FuzzyOptimalSolve) { return {"together", "each"}; }
inline std::vector<std::string> wordsOf(FuzzyOptimalDisturbance) {
  return {"inside", "outside", "none"};
}

struct FuzzyOptimalParams : PredictiveLawParams {
  FuzzyOptimalTuning tuning;
  FuzzyOptimalSolve solve{FuzzyOptimalSolve::kTogether};
  FuzzyOptimalDisturbance disturbance{FuzzyOptimalDisturbance::kInside};
  bool observe{false};      ///< state and d come from an observer with stated noise; inside only
  ObserverParams observer;  ///< used if observe
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

const SettingsTable<FuzzyOptimalParams>& fuzzyOptimalSettings();  ///< what may change in a run

/// Rule g predicts from measured outputs and applied inputs
///   y(k+1) = sum a y + sum b u + c + d_g,   d_g = y(k) - y_hat_g(k|k-1),
/// with its own d_g inside the recursion ("inside"): at rest every rule then agrees with the plant,
/// so there is no offset, whatever P, M and the move weights are. With `observe` y(k), the past
/// outputs and d are those of a ModelObserver, which knows how noisy the measurements are. Added to
/// the outputs of the recursion instead ("outside") it leaves an offset for P > 1, as does any
/// weight towards an input target that is not the right one. The input is sum_g w_g u_g (taieb2017,
/// eq. 12), w_g the firing weights at the measured antecedents (u(k) replaced by u(k-1)); all
/// outputs must share one premise partition (see splitRules()). Gains are computed when a model or
/// a tuning comes; both take over without a bump (PredictiveLaw). The measured past is kept if the
/// lags are the same. The prediction is that of the blended model and law.
/// signals(): NAME_error (y - y_hat of the blended rules) of each output and NAME_unclipped of each
/// input.
class FuzzyOptimalLaw final : public PredictiveLaw {
 public:
  FuzzyOptimalLaw(const FuzzyOptimalParams& params, const InputLimits& limits,
                  const PlantInfo& plant);

  /// @throws InputError also for outputs with different partitions, another number of rules than
  /// there are weights, or an input without effect within the horizon and without weight.
  void setModel(const TsModel& model) override;
  /// Whether setModel() would take it, already matched to the plant. @throws InputError as it does.
  static void check(const FuzzyOptimalParams& params, const TsModel& model);
  /// From the next sample on, without a bump. @throws InputError, then nothing changes.
  void retune(FuzzyOptimalTuning tuning);
  const FuzzyOptimalTuning& tuning() const { return params_.tuning; }  ///< the latest
  /// Tuning and reference poles under the keys of a loop file. Weights and targets: one number for
  /// all, one for each signal, or NAME=number; groups for each rule are separated by semicolons, a
  /// single group is for all rules.
  Settings settings() const override;
  bool retune(const Settings& settings) override;

 private:
  void retuneTo(FuzzyOptimalParams params);

  FuzzyOptimalParams params_;     ///< with the latest tuning
  std::optional<TsModel> model_;  ///< matched, for a new tuning
};

}  // namespace fpc
