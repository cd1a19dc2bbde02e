// Readers of the sections that keep plant and controller apart from what cannot be. Private to the
// room.
#pragma once

#include "fmbpc/base/yaml_section.hpp"
#include "fmbpc/config/gateway_params.hpp"
#include "fmbpc/config/loop_file.hpp"
#include "fmbpc/config/plausibility_file.hpp"

namespace fpc {

GatewayParams readGateway(YamlSection& root, const LoopFile& loop);
PlausibilityFile readPlausibility(YamlSection& root, const LoopFile& loop);

}  // namespace fpc
