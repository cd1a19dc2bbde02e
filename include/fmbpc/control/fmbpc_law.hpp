// Fuzzy model-based predictive control: an explicit law from the local Takagi-Sugeno model.
#pragma once

#include <memory>
#include <string>

#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/reference.hpp"
#include "fmbpc/fuzzy/local_model.hpp"

namespace fpc {

struct FmbpcParams {
  std::string law{"published"};          ///< published (u = e_x / m2) or general (weighted)
  int coincidence_steps{6};              ///< H
  Vector reference_pole;                 ///< n_y, a_r
  bool preview{false};                   ///< references follow the setpoint schedule over the horizon
  Vector weight_output;                  ///< n_y, diagonal W (general)
  Vector weight_move;                    ///< n_u, diagonal L (general)
  std::string realisation{"parallel"};   ///< parallel: own state, y_m = z; realigned: state from measurements
  std::string antecedent{"model"};       ///< outputs in the antecedents: model or measured
  double offset_gain{0.2};               ///< filter gain of the one-step error w_hat (realigned)
  bool disturbance_feedforward{true};    ///< d(k) in the model; false: the nominal d
  Vector disturbance_nominal;            ///< n_d, used without feedforward
  double transfer_decay{0.9};            ///< how fast the bias of a bumpless start decays per sample, [0, 1)
  int prediction_steps{1};               ///< n_c of the predictive_action
  void validate(Eigen::Index n_y, Eigen::Index n_u) const;  ///< @throws InputError naming the field
};

/// The law of Vallejo 2019 eqs. 19-37, with past inputs in the state:
///   M = C S_H B,  e = y_r(k+H) - y + y_m - C A^H xi - C S_H g,
///   published: u = e_x / m2 (row of the last output, where u(k-1) does not enter);
///   general:   u = (M' W M + L)^-1 (M' W e + L u(k-1)).
class FmbpcLaw final : public Controller {
 public:
  FmbpcLaw(FmbpcParams params, InputLimits limits, PlantInfo plant);
  ~FmbpcLaw() override;

  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint, ControllerOutput& output) override;
  bool needsModel() const override { return true; }
  void setModel(const TsModel& model) override;
  const std::vector<std::pair<std::string, double>>& signals() const override;

 private:
  struct Memory;
  std::unique_ptr<Memory> memory_;
};

}  // namespace fpc
