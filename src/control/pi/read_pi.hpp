// Reads a PI from its section. Private to the room.
#pragma once

#include "control/pi/pi.hpp"
#include "fmbpc/control/registry.hpp"
#include "fmbpc/control/settings_table.hpp"

namespace fpc {

/// What may change in a run: a value for the input of every loop.
struct PiGains {
  Vector kp, ki_per_h;
};
const SettingsTable<PiGains>& piSettings();

/// Points [output, value] of a curve.
std::vector<CurvePoint> readCurve(YamlSection& section, const std::string& key,
                                  const std::string& value_name);
/// Keys of one loop besides its gains.
void readPiTerms(YamlSection& section, PiTerms& terms, const ControllerContext& loop);

}  // namespace fpc
