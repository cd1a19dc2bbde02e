// Section `guard`: what a law does outside its model's data, and when it is locked up.
#include "base/yaml_node.hpp"
#include "config/read.hpp"

namespace fpc {

void readGuard(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  bool off = false;
  YamlSection section = root.sectionOrOff("guard", off);
  GuardParams& guard = loop.guard;
  guard.enabled = !off;
  section.interval("trust", guard.trust_low, guard.trust_high, {0.0, 1.0}, "[low, high]");
  section.integer("look_ahead", guard.look_ahead, 0);
  section.integer("horizon_least", guard.horizon_least, 0);
  section.integer("return_samples", guard.return_samples, 1);
  section.integer("lock_samples", guard.lock_samples, 0);
  section.integer("growing_swings", guard.growing_swings, 0);
  guard.lock_outputs = loop.controller->signalUse(controllerContext(loop)).followed;
  loop.fallback = readFallback(section, loop);
  checked(section, [&] {
    guard.validate(static_cast<Eigen::Index>(names.outputs.size()), loop.fallback != nullptr);
  });
  section.finish();
}

}  // namespace fpc
