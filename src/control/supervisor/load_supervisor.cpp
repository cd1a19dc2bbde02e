#include "control/supervisor/load_supervisor.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

void LoadSupervisorParams::validate() const {
  const std::string key = "controller.";
  for (const auto& [name, value] :
       {std::pair{"kp", kp}, {"load.gain", load_gain}, {"load.nominal", nominal_load}})
    require(std::isfinite(value), key + name, "a finite number");
  require(nominal_load > 0.0, key + "load.nominal", "a number > 0");
  require(std::isfinite(ki_per_h) && kp * ki_per_h > 0.0, key + "ki_per_h",
          "a number with the sign of kp");
  require(std::isfinite(tracking_time_h) && tracking_time_h > 0.0, key + "tracking_time_h",
          "a time > 0");
  require(integral_limit >= 0.0, key + "integral_limit", "a number >= 0");
}

LoadSupervisor::LoadSupervisor(const LoadSupervisorParams& params, InputLimits limits,
                               const PlantInfo& plant)
    : params_(params),
      next_params_(params),
      limits_(std::move(limits)),
      sample_time_h_(plant.sample_time_s / 3600.0) {
  params_.validate();
  limits_.validate(static_cast<Eigen::Index>(plant.inputs.size()));
  const std::string& input = plant.inputs[static_cast<std::size_t>(params_.input)].name;
  signals_ = {{input + "_integral", 0.0}, {"load", 0.0}};
}

const SettingsTable<LoadSupervisorParams>& loadSupervisorSettings() {
  using Params = LoadSupervisorParams;
  static const SettingsTable<Params> table =
      SettingsTable<Params>()
          .number("kp", &Params::kp, "input unit per output unit", -1e9, 1e9)
          .number("ki_per_h", &Params::ki_per_h, "kp / Ti, input unit per output unit and h", -1e9,
                  1e9)
          .number("tracking_time_h", &Params::tracking_time_h, "Tt [h]", 1e-6, 1e6)
          .number("load_gain", &Params::load_gain, "input unit per relative load: load.gain", -1e9,
                  1e9);
  return table;
}

Settings LoadSupervisor::settings() const {
  return loadSupervisorSettings().show(next_params_, {{}, {}});
}

bool LoadSupervisor::retune(const Settings& settings) {
  LoadSupervisorParams next = next_params_;
  loadSupervisorSettings().take(settings, {{}, {}}, next);
  next.validate();
  next_params_ = next;
  return true;
}

void LoadSupervisor::reset(const Measurement& start) {
  integral_ = 0.0;
  running_ = false;
  transfer_pending_ = start.header.step > 0;
}

double LoadSupervisor::ahead(const Measurement& now, double error) const {
  const double load = now.disturbances[params_.concentration] * now.disturbances[params_.flow] /
                      params_.nominal_load;
  return params_.kp * error + params_.load_gain * (load - 1.0);
}

void LoadSupervisor::step(const Measurement& now, const SetpointSource& setpoint,
                          ControllerOutput& output) {
  output.begin();
  output.input = now.input_applied;
  output.reference = setpoint.present();
  const double error = now.outputs[params_.output] - setpoint.present()[params_.output];
  const double before = ahead(now, error);
  params_ = next_params_;
  const double direct = ahead(now, error);
  if (running_ && std::isfinite(before - direct)) integral_ += before - direct;
  running_ = true;
  const double limit = params_.integral_limit;
  if (transfer_pending_ && std::isfinite(direct))
    integral_ = std::clamp(now.input_applied[params_.input] - direct, -limit, limit);
  const double unclipped = direct + integral_;
  if (!std::isfinite(unclipped)) {
    output.ok = false;
    output.source = ActionSource::kHeld;
    output.events.add({EventCode::kLawFailed});
    limits_.clip(output.input, now.input_applied);
    return;
  }
  // Free of rounding where the integral could take up all of the difference.
  const bool handed = transfer_pending_ && std::abs(integral_) < limit;
  transfer_pending_ = false;
  double& u = output.input[params_.input];
  u = handed ? u : unclipped;
  limits_.clip(output.input, now.input_applied);
  if (u != unclipped && !handed) output.source = ActionSource::kClipped;
  const double rate = params_.ki_per_h * error + (u - unclipped) / params_.tracking_time_h;
  integral_ = std::clamp(integral_ + sample_time_h_ * rate, -limit, limit);
  signals_[0].second = integral_;
  signals_[1].second = (direct - params_.kp * error);
}

}  // namespace fpc
