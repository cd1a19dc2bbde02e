// Fuzzy model-based predictive control: an explicit law from the local Takagi-Sugeno model.
#pragma once

#include <memory>
#include <string>

#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/disturbance_observer.hpp"
#include "fmbpc/control/reference.hpp"
#include "fmbpc/fuzzy/local_model.hpp"

namespace fpc {

struct FmbpcParams {
  std::string law{"published"};  ///< published (u = e_x / m2), general (weighted) or iterated
  int coincidence_steps{6};      ///< H
  Vector reference_pole;         ///< n_y, a_r
  bool preview{false};           ///< references follow the setpoint schedule over the horizon
  Vector weight_output;          ///< n_y, diagonal W (general, iterated)
  Vector weight_move;            ///< n_u, diagonal L (general, iterated)
  int horizon_steps{40};         ///< N (iterated)
  int iterations{8};             ///< most linearisations per sample (iterated)
  int forecast_period_steps{0};  ///< d is expected as it was so long ago; 0: as it is (iterated)
  double forecast_pole{0.975};   ///< how today's difference fades per sample, [0, 1]
  std::string realisation{
      "parallel"};  ///< parallel: own state, y_m = z; realigned: state from measurements;
                    ///< literal: parallel in the state space of Blazic and Skrjanc, CanonicalForm;
                    ///< observer: state and disturbance from a ModelObserver
  std::string antecedent{"model"};     ///< outputs in the antecedents: model or measured
  int delay_steps{0};                  ///< transport delay taken out of the model, see FmbpcLaw
  int reference_lead_steps{0};         ///< the law aims at y_r(k + H + this)
  double offset_gain{0.2};             ///< filter gain of the one-step error w_hat (realigned)
  ObserverParams observer;             ///< used by realisation observer
  bool disturbance_feedforward{true};  ///< d(k) in the model; false: the nominal d
  Vector disturbance_nominal;          ///< n_d, used without feedforward
  double transfer_decay{0.9};  ///< how fast the bias of a bumpless start decays per sample, [0, 1)
  int prediction_steps{1};     ///< n_c of the predictive_action
  /// @throws InputError naming the field ("controller.coincidence_steps"). The weights matter to
  /// `general` only.
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;
  Eigen::Index referenceSteps() const;  ///< how far ahead the law reads its references
};

/// The law of Vallejo 2019 eqs. 19-37, with past inputs in the state:
///   M = C S_H B,  e = y_r(k+H) - y + y_m - C A^H xi - C S_H g,
///   published: u = e_x / m2 (row of the last output; one input; the other outputs and their
///   setpoints play no part); general:   u = (M' W M + L)^-1 (M' W e + L u(k-1)).
/// iterated: the inputs of N samples that minimise the weighted squares of errors and moves inside
/// the limits, rules blended along the path, references and disturbances ahead (see PathPlanner,
/// DisturbanceForecast); the first is applied, the rest is handed to an optimizer as feedforward.
/// delay_steps takes a transport delay out of the model: xi, A, B, C, g and H are then those of the
/// undelayed process, and y_m in e is the output of the model with its delay, which runs beside it
/// on the same applied inputs (Blazic and Skrjanc 2007, eqs. 17-27). With realisation observer the
/// late measurement corrects the state of its own time, and xi is that state run forward.
/// A start in the middle of a run adds a bias to u that makes it the applied input and dies out
/// with transfer_decay. A new model takes over in the next step: the old one still says what u(k)
/// would have been, and the new one starts with a bias that makes its u(k) the very same. If both
/// models have the same lags, the measured past is handed over as well, and the own state if only
/// consequents differ; otherwise (and always with a delay taken out, or literal) the new one starts
/// at rest. If no rule fires the nearest one is used, with a remark. If the gains are singular or
/// anything is not finite the last applied input is held (clipped), ok is false, and there is no
/// prediction. signals(): NAME_model (y_m), NAME_correction (y - y_m, or w_hat) of each output and,
/// with a delay, NAME_undelayed (what the output will be delay_steps later); NAME_unclipped of each
/// input.
class FmbpcLaw final : public Controller {
 public:
  FmbpcLaw(FmbpcParams params, InputLimits limits, PlantInfo plant);
  ~FmbpcLaw() override;

  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override;
  const std::vector<std::pair<std::string, double>>& signals() const override;

 private:
  struct Belief;  ///< everything whose size depends on the model
  struct Memory;

  void estimate(const Measurement& now);
  bool computeGains();
  bool think(const Measurement& now, bool& solvable);
  bool handOver(const Measurement& now, bool& solvable);
  void propose(const Measurement& now);
  bool proposePath(const Measurement& now);
  void transfer(const Measurement& now);
  void predict(const Measurement& now, const SetpointSource& setpoint,
               PredictiveAction& prediction) const;
  void hold(const Measurement& now, const char* reason, ControllerOutput& output);
  void refreshSignals(const Measurement& now);

  std::unique_ptr<Memory> memory_;
};

}  // namespace fpc
