// A supervisor of one output: PI control with the measured load ahead of it, as good plants run
// their aeration. The honest baseline of the predictive laws on BSM1.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fmbpc/control/controller.hpp"
#include "fmbpc/control/settings_table.hpp"

namespace fpc {

/// e = y - setpoint,  v = kp e + I + load_gain (concentration flow / nominal load - 1),
/// u = clip(v),  dI/dt = ki e + (u - v) / Tt,  |I| <= integral_limit.
struct LoadSupervisorParams {
  int input{}, output{};
  int concentration{}, flow{};  ///< measured disturbances whose product is the load
  double nominal_load{1.0};     ///< their product at the usual load
  double kp{}, ki_per_h{};      ///< input per output unit, and hour; of the same sign
  double load_gain{};           ///< input per relative load
  double tracking_time_h{1.0};
  double integral_limit{1e9};  ///< in units of the input
  void validate() const;       ///< @throws InputError naming the field
};

const SettingsTable<LoadSupervisorParams>& loadSupervisorSettings();  ///< what may change in a run

/// Other inputs stay where they are. A start in the middle of a run gives the integral the value at
/// which the input stays, as far as its limit allows.
class LoadSupervisor final : public Controller {
 public:
  /// @throws InputError naming the field.
  LoadSupervisor(const LoadSupervisorParams& params, InputLimits limits, const PlantInfo& plant);
  void reset(const Measurement& start) override;
  void step(const Measurement& now, const SetpointSource& setpoint,
            ControllerOutput& output) override;
  const std::vector<std::pair<std::string, double>>& signals() const override { return signals_; }
  Settings settings() const override;
  /// From the next step on: the integral takes up what the other parts gain or lose.
  bool retune(const Settings& settings) override;

 private:
  double ahead(const Measurement& now, double error) const;

  LoadSupervisorParams params_, next_params_;
  InputLimits limits_;
  double sample_time_h_, integral_{};
  bool transfer_pending_{false}, running_{false};
  std::vector<std::pair<std::string, double>> signals_;
};

}  // namespace fpc
