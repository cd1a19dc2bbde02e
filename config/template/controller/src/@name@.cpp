// A proportional-integral law for one input and one output. Put your own law in its place.
#include <fmbpc/base/signals.hpp>
#include <fmbpc/control/registry.hpp>
#include <fmbpc/control/settings_table.hpp>

#include <algorithm>

namespace {

using fpc::Vector;

struct @Name@Params {
  double gain{1.0};
  double integral_time_s{600.0};
};

/// What may change in a run: one row a key.
const fpc::SettingsTable<@Name@Params>& table() {
  static const auto rows =
      fpc::SettingsTable<@Name@Params>()
          .number("gain", &@Name@Params::gain, "input unit per output unit", -1e9, 1e9)
          .number("integral_time_s", &@Name@Params::integral_time_s, "[s]", 1e-3, 1e9);
  return rows;
}

class @Name@ final : public fpc::Controller {
 public:
  @Name@(const @Name@Params& params, const fpc::ControllerContext& loop)
      : params_(params), limits_(loop.limits), sample_time_s_(loop.plant.sample_time_s) {}

  /// The next step moves on from the input in force.
  void reset(const fpc::Measurement&) override { begins_ = true; }

  /// u(k), inside its limits; no allocation, no exception.
  void step(const fpc::Measurement& now, const fpc::SetpointSource& setpoint,
            fpc::ControllerOutput& output) override {
    const double error = setpoint.present()[0] - now.outputs[0];
    if (begins_) integral_ = now.input_applied[0] - params_.gain * error;
    const double further = params_.gain * sample_time_s_ / params_.integral_time_s * error;
    if (!begins_) integral_ += further;
    begins_ = false;
    output.reference = setpoint.present();
    output.input.resize(1);
    output.input[0] = integral_ + params_.gain * error;
    const double asked = output.input[0];
    limits_.clip(output.input, now.input_applied);
    if (output.input[0] == asked) {
      last_error_ = error;
      return;
    }
    output.source = fpc::ActionSource::kClipped;
    integral_ = output.input[0] - params_.gain * error;  // it does not wind up
    last_error_ = error;
  }

  fpc::Settings settings() const override { return table().show(params_, {{}, {}}); }
  bool retune(const fpc::Settings& settings) override {
    @Name@Params next = params_;
    table().take(settings, {{}, {}}, next);
    fpc::require(next.integral_time_s > 0.0, "controller.integral_time_s", "a time > 0");
    integral_ += (params_.gain - next.gain) * last_error_;  // without a bump
    params_ = next;
    return true;
  }

 private:
  @Name@Params params_;
  fpc::InputLimits limits_;
  double sample_time_s_, integral_{}, last_error_{};
  bool begins_{true};
};

/// The section `controller` of a loop file.
@Name@Params read(fpc::YamlSection& section, const fpc::ControllerContext& loop) {
  @Name@Params params;
  section.number("gain", params.gain, fpc::kFinite);
  section.number("integral_time_s", params.integral_time_s, fpc::kFinitePositive);
  if (loop.inputCount() != 1 || loop.outputCount() != 1)
    section.fail("type", "a plant with one input and one output");
  return params;
}

std::unique_ptr<fpc::Controller> make(const @Name@Params& params,
                                      const fpc::ControllerContext& loop) {
  return std::make_unique<@Name@>(params, loop);
}

fpc::ControllerType describe() {
  fpc::ControllerType type{"@name@", "proportional and integral, one input, one output"};
  type.settings = table().infos();
  return type;
}

const bool kRegistered = fpc::registerController<@Name@Params>({describe(), &read, &make});

}  // namespace
