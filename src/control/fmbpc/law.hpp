// Fuzzy model-based predictive control: an explicit law from the local Takagi-Sugeno model.
#pragma once

#include <string>
#include <vector>

#include "control/fmbpc/disturbance_forecast.hpp"
#include "estimation/disturbance_observer.hpp"
#include "fmbpc/control/predictive_law.hpp"
#include "fmbpc/control/settings_table.hpp"

namespace fpc {

/// How u(k) follows from the model: u = e_x / m2, weighted, or the best path.
enum class FmbpcForm { kPublished, kGeneral, kIterated };
/// Where the state comes from. parallel: its own, y_m = z; realigned: measurements; literal:
/// parallel in the state space of blazic2007 (CanonicalForm), with rules at measured outputs;
/// observer: a ModelObserver.
enum class FmbpcRealisation { kParallel, kRealigned, kLiteral, kObserver };

inline std::vector<std::string> wordsOf(FmbpcForm) { return {"published", "general", "iterated"}; }
inline std::vector<std::string> wordsOf(FmbpcRealisation) {
  return {"parallel", "realigned", "literal", "observer"};
}

struct FmbpcParams : PredictiveLawParams {
  FmbpcForm law{FmbpcForm::kPublished};
  int coincidence_steps{6};      ///< H
  Vector weight_output;          ///< n_y, diagonal W (general, iterated)
  Vector weight_move;            ///< n_u, diagonal L (general, iterated)
  Vector weight_input;           ///< n_u, diagonal R (iterated); empty: 0
  Vector input_target;           ///< n_u, u_t, with weight_input
  int horizon_steps{40};         ///< N (iterated)
  int iterations{8};             ///< most linearisations per sample (iterated)
  int forecast_period_steps{0};  ///< d is expected as it was so long ago; 0: as it is (iterated)
  int forecast_memory_steps{0};  ///< over which it is judged how far to trust that; 0: wholly
  double forecast_pole{0.975};   ///< how today's difference fades per sample, [0, 1]
  FmbpcRealisation realisation{FmbpcRealisation::kParallel};
  int delay_steps{0};           ///< transport delay taken out of the model, see FmbpcLaw
  int reference_lead_steps{0};  ///< added to every time at which a reference is met
  double offset_gain{0.2};      ///< filter gain of the one-step error w_hat (realigned)
  ObserverParams observer;      ///< used by realisation observer
  /// @throws InputError naming the field ("controller.coincidence_steps"). The weights matter to
  /// `general` and `iterated` only.
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
  Eigen::Index aimedColumn() const;     ///< of references from k+1 on: what u(k) aims at
  Eigen::Index referenceSteps() const;  ///< how far ahead the law reads its references
};

/// The laws that heed this key of the section, in words, if `law` does not; else null.
const char* lawsInsteadOf(FmbpcForm law, const std::string& key);
const SettingsTable<FmbpcParams>& fmbpcSettings();  ///< what may change in a run

/// The law of vallejo2019, eqs. 19-37, with past inputs in the state:
///   M = C S_H B,  e = y_r(k+H) - y + y_m - C A^H xi - C S_H g,
///   published: u = e_x / m2 (row of the last output; one input; the other outputs and their
///   setpoints play no part); general:   u = (M' W M + L)^-1 (M' W e + L u(k-1)).
/// iterated: the inputs of N samples that minimise the weighted squares of errors, moves and
/// distances to a target inside the limits, rules blended along the path, references and
/// disturbances ahead (see InputLimitedIlqr, DisturbanceForecast); the first is applied, the rest
/// is handed to an optimizer as feedforward. delay_steps takes a transport delay out of the model:
/// xi, A, B, C, g and H are then those of the undelayed process, and y_m in e is the output of the
/// model with its delay, which runs beside it on the same applied inputs (blazic2007, eqs. 17-27).
/// With realisation observer the late measurement corrects the state of its own time, and xi is
/// that state run forward. A start in the middle of a run, a new model and a new tuning come
/// without a bump (PredictiveLaw). If two models have the same lags, the measured past is handed
/// over as well, and the own state if only consequents differ; otherwise (and always with a delay
/// taken out, or literal) the new one starts at rest. If no rule fires the nearest one is used,
/// with an event. If the gains are singular or anything is not finite the last applied input is
/// held. signals(): NAME_model (y_m), NAME_correction (y - y_m, or w_hat) of each output and, with
/// a delay, NAME_undelayed (what the output will be delay_steps later); NAME_unclipped of each
/// input; NAME_estimate of each disturbance in observer.estimated.
class FmbpcLaw final : public PredictiveLaw {
 public:
  FmbpcLaw(const FmbpcParams& params, const InputLimits& limits, const PlantInfo& plant);

  void reset(const Measurement& start) override;
  bool expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead) override;
  void setModel(const TsModel& model) override;
  Settings settings() const override;
  bool retune(const Settings& settings) override;

 private:
  void note(const LawSample& sample) override;
  void requireHeeded(const Settings& asked, const FmbpcParams& next) const;

  FmbpcParams params_;  ///< with the latest tuning
  DisturbanceForecast forecast_;
};

}  // namespace fpc
