// Section `guard`: what a law does outside its model's data, and when it is locked up.
#include "base/yaml_node.hpp"
#include "config/read.hpp"
#include "control/pi/pi_reader.hpp"

namespace fpc {

void readGuard(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("guard");
  GuardParams& guard = loop.guard;
  section.boolean("enabled", guard.enabled);
  section.number("trust_low", guard.trust_low, {0.0, 1.0});
  section.number("trust_high", guard.trust_high, {0.0, 1.0});
  section.number("least_move", guard.least_move, {0.0, 1.0, true});
  section.integer("look_ahead", guard.look_ahead, 0);
  section.integer("horizon_least", guard.horizon_least, 0);
  section.integer("return_samples", guard.return_samples, 1);
  section.integer("lock_samples", guard.lock_samples, 0);
  section.number("lock_error", guard.lock_error, kFinitePositive);
  section.number("lock_step", guard.lock_step, {0.0, 1.0, true});
  section.integer("lock_release", guard.lock_release, 1);
  section.number("swing_move", guard.swing_move, {0.0, 1.0});
  section.integer("swing_release", guard.swing_release, 1);
  guard.lock_outputs = loop.controller->signalUse(controllerContext(loop)).followed;
  std::vector<std::string> outputs;
  section.subset("lock_outputs", outputs, names.outputs);
  if (!outputs.empty()) guard.lock_outputs.clear();
  for (std::size_t i = 0; i < names.outputs.size(); ++i)
    for (const auto& output : outputs)
      if (output == names.outputs[i]) guard.lock_outputs.push_back(static_cast<Eigen::Index>(i));
  const YAML::Node fallback = section.raw("pi");
  if (fallback.IsDefined() && !fallback.IsNull()) {
    YamlSection pi = section.section("pi");
    guard.pi = std::make_shared<const PiParams>(readPi(pi, controllerContext(loop)));
    pi.finish();
  }
  checked(section, [&] {
    guard.validate(static_cast<Eigen::Index>(names.outputs.size()),
                   static_cast<Eigen::Index>(names.inputs.size()),
                   static_cast<Eigen::Index>(names.seen_disturbances.size()));
  });
  section.finish();
}

}  // namespace fpc
