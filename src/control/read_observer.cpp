// Section `controller.observer` of the laws that estimate a disturbance.
#include "control/read_observer.hpp"

#include <algorithm>

namespace fpc {
namespace {

constexpr double kPart = 0.02;    // of the noise: what the disturbance changes per sample
constexpr double kNoNoise = 1.0;  // without noise it does not matter

void readEstimated(YamlSection& observer, ObserverParams& params,
                   const std::vector<std::string>& measured) {
  YamlSection section = observer.section("estimated");
  for (const std::string& name : section.keys()) {
    if (std::count(measured.begin(), measured.end(), name) > 0)
      section.fail(name, "a disturbance that is not measured");
    YamlSection about = section.section(name);
    EstimatedDisturbance d{name};
    need(about, "std", "a number > 0: how far from 0 it may be at a start");
    about.number("std", d.std, kFinitePositive);
    about.number("walk_std", d.walk_std, kFiniteNotNegative);
    about.finish();
    params.estimated.push_back(d);
  }
  section.finish();
}

}  // namespace

bool readObserver(YamlSection& controller, ObserverParams& params, const ControllerContext& loop,
                  ObserverKey key) {
  bool off = false;
  YamlSection section = controller.sectionOrOff("observer", off);
  params.noise_std = loop.noise_std;
  if (params.noise_std.size() == 0) params.noise_std = Vector::Zero(loop.outputCount());
  section.byName("noise_std", params.noise_std, loop.outputs(), kFiniteNotNegative);
  params.disturbance_std = kPart * params.noise_std;
  params.disturbance_std =
      (params.noise_std.array() > 0.0).select(params.disturbance_std, kNoNoise);
  section.byName("disturbance_std", params.disturbance_std, loop.outputs(), kFiniteNotNegative);
  if (key == ObserverKey::kInputStd) {
    Vector stated = Vector::Zero(loop.inputCount());
    section.byName("input_std", stated, loop.inputs(), kFiniteNotNegative);
    if (section.has("input_std")) params.input_std = stated;
  }
  if (key == ObserverKey::kEstimated) readEstimated(section, params, loop.disturbances());
  if (off && key == ObserverKey::kAlways) controller.fail("observer", "a mapping");
  checked(section, [&] { params.validate(static_cast<Eigen::Index>(loop.outputs().size())); });
  section.finish();
  return params.noisy() && !off;
}

}  // namespace fpc
