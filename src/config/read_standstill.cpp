// Section `standstill`: sensors that stand still, and what is done meanwhile.
#include <algorithm>
#include <cmath>

#include "config/read.hpp"
#include "fmbpc/control/standstill.hpp"

namespace fpc {
namespace {

using Eigen::Index;

void readWatched(YamlSection& section, const std::vector<std::string>& names, bool outputs,
                 std::vector<WatchedSignal>& signals) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    section.markRead(names[i]);
    if (!section.has(names[i])) continue;
    WatchedSignal signal{names[i], outputs, static_cast<Index>(i), 0.0};
    section.number(names[i], signal.least_change, kFinitePositive);
    signals.push_back(signal);
  }
}

}  // namespace

void readStandstill(YamlSection& root, LoopFile& loop, const LoopNames& names) {
  YamlSection section = root.section("standstill");
  StandstillParams& params = loop.standstill;
  bool enabled = true;
  double window_h = 6.0;
  section.boolean("enabled", enabled);
  section.number("window_h", window_h, kFinitePositive);
  section.number("others_change", params.others_change, kFinitePositive);
  params.window_samples =
      std::max(2, static_cast<int>(std::lround(window_h * 3600.0 / loop.plant_info.sample_time_s)));
  YamlSection signals = section.section("signals");
  readWatched(signals, names.outputs, true, params.signals);
  readWatched(signals, names.seen_disturbances, false, params.signals);
  signals.finish();
  params.usual = loop.disturbance_nominal;
  section.byName("usual", params.usual, names.seen_disturbances, kFinite);
  params.fallback = loop.simulation.actuator.initial;
  section.byName("fallback", params.fallback, names.inputs, kFinite);
  for (auto& item : section.list("fallback_plan"))
    params.fallback_plan.push_back(
        readPlanTerm(item, "input", names.inputs, names.outputs, names.seen_disturbances));
  if (!enabled) params.signals.clear();
  section.finish();
}

}  // namespace fpc
