// Section `controller.observer` of the laws that estimate a disturbance.
#include "fmbpc/control/read_observer.hpp"

namespace fpc {
namespace {

constexpr double kPart = 0.02;    // of the noise: what the disturbance changes per sample
constexpr double kNoNoise = 1.0;  // without noise it does not matter

}  // namespace

bool readObserver(YamlSection& controller, ObserverParams& params, const ControllerContext& loop,
                  bool at_inputs) {
  YamlSection section = controller.section("observer");
  params.noise_std = loop.noise_std;
  if (params.noise_std.size() == 0) params.noise_std = Vector::Zero(loop.outputCount());
  section.byName("noise_std", params.noise_std, loop.outputs(), kFiniteNotNegative);
  params.disturbance_std = kPart * params.noise_std;
  params.disturbance_std =
      (params.noise_std.array() > 0.0).select(params.disturbance_std, kNoNoise);
  section.byName("disturbance_std", params.disturbance_std, loop.outputs(), kFinitePositive);
  if (at_inputs) {
    Vector stated = Vector::Zero(loop.inputCount());
    section.byName("input_std", stated, loop.inputs(), kFiniteNotNegative);
    if (section.has("input_std")) params.input_std = stated;
  }
  section.boolean("adaptive", params.adaptive);
  section.number("adaptation", params.adaptation, {0.0, 1.0, true});
  if (params.adaptive && !section.has("disturbance_std") && !params.noise_std.any())
    section.fail("disturbance_std", "numbers > 0 where adaptive is to find the noise");
  bool enabled = params.noisy();
  section.boolean("enabled", enabled);
  checked(section, [&] { params.validate(static_cast<Eigen::Index>(loop.outputs().size())); });
  section.finish();
  return enabled;
}

}  // namespace fpc
