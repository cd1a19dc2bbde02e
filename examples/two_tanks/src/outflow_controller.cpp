// A controller of one's own: what flows out at the setpoint flows in, a PI term sees to the rest.
//
//   q = c sqrt(setpoint) - f + kp (e + (1/Ti) int e dt),   e = setpoint - level
//
// c and f are what the operator knows: the outlet's coefficient and the measured feed.
#include <fmbpc/control/registry.hpp>
#include <fmbpc/control/settings_table.hpp>

#include <algorithm>
#include <cmath>

namespace {

struct OutflowParams {
  int output{};         // index of the level it holds
  double outlet{10.0};  // c [l/(s m^0.5)]
  double kp{5.0};       // [l/(s m)]
  double integral_time_s{600.0};
};

/// What may change in a run.
const fpc::SettingsTable<OutflowParams>& table() {
  using Params = OutflowParams;
  static const auto table =
      fpc::SettingsTable<Params>()
          .number("kp", &Params::kp, "proportional gain [l/(s m)]", 0.0, 1000.0)
          .number("integral_time_s", &Params::integral_time_s, "Ti [s]", 1.0, 1e6);
  return table;
}

class OutflowController final : public fpc::Controller {
 public:
  OutflowController(const OutflowParams& params, const fpc::ControllerContext& loop)
      : params_(params), limits_(loop.limits), sample_time_s_(loop.plant.sample_time_s) {}

  void reset(const fpc::Measurement& start) override {
    integral_ = 0.0;
    transfer_ = start.header.step > 0;  // in a run: u(k) = input_applied
  }

  void step(const fpc::Measurement& now, const fpc::SetpointSource& setpoint,
            fpc::ControllerOutput& output) override {
    const double asked = setpoint.present()[params_.output];
    const double error = asked - now.outputs[params_.output];
    const double rest = params_.outlet * std::sqrt(std::max(asked, 0.0)) - now.disturbances[0];
    if (transfer_) integral_ = now.input_applied[0] - rest - params_.kp * error;
    transfer_ = false;
    const double proposal = rest + params_.kp * error + integral_;
    output.input = now.input_applied;
    output.input[0] = proposal;
    limits_.clip(output.input, now.input_applied);
    const double clipped = output.input[0] - proposal;
    const double change = params_.kp * error * sample_time_s_ / params_.integral_time_s;
    if (clipped * change >= 0.0) integral_ += change;  // no wind-up beyond the limits
    output.reference = setpoint.present();
    output.source = clipped == 0.0 ? fpc::ActionSource::kBase : fpc::ActionSource::kClipped;
    output.predictive = false;
    output.ok = true;
    last_error_ = error;
  }

  fpc::Settings settings() const override { return table().show(params_, {{}, {}}); }

  bool retune(const fpc::Settings& settings) override {
    OutflowParams next = params_;
    table().take(settings, {{}, {}}, next);
    fpc::require(next.kp >= 0.0 && next.integral_time_s > 0.0, "controller", "kp >= 0, a time > 0");
    integral_ += (params_.kp - next.kp) * last_error_;  // no bump
    params_ = next;
    return true;
  }

 private:
  OutflowParams params_;
  fpc::InputLimits limits_;
  double sample_time_s_;
  double integral_{}, last_error_{};
  bool transfer_{false};
};

OutflowParams read(fpc::YamlSection& section, const fpc::ControllerContext& loop) {
  OutflowParams params;
  params.output = fpc::indexByName(section, "output", loop.outputs());
  section.number("outlet", params.outlet, fpc::kFinitePositive);
  section.number("kp", params.kp, fpc::kFiniteNotNegative);
  section.number("integral_time_s", params.integral_time_s, fpc::kFinitePositive);
  if (loop.inputCount() != 1 || loop.plant.disturbances.size() != 1)
    section.fail("type", "a plant with one input and one measured feed");
  return params;
}

std::unique_ptr<fpc::Controller> make(const OutflowParams& params,
                                      const fpc::ControllerContext& loop) {
  return std::make_unique<OutflowController>(params, loop);
}

/// It goes on without the other levels.
fpc::SignalUse uses(const OutflowParams& params, const fpc::ControllerContext& loop) {
  fpc::SignalUse use = fpc::noSignal(loop);
  use.needed[static_cast<std::size_t>(params.output)] = true;
  use.needed.back() = true;  // the feed
  use.followed = {params.output};
  return use;
}

fpc::ControllerType describe() {
  fpc::ControllerType type{"outflow", "inflow equals the outflow at the setpoint, plus a PI term"};
  type.settings = table().infos();
  return type;
}

const bool kRegistered =
    fpc::registerController<OutflowParams>({describe(), &read, &make, nullptr, &uses});

}  // namespace
