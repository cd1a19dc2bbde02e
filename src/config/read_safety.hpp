// Readers of the sections that keep plant and controller apart from what cannot be, or watch for
// it. Private to the room.
#pragma once

#include "config/loop_file.hpp"
#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

void readEstimator(YamlSection& root, LoopFile& loop);
void readGateway(YamlSection& root, LoopFile& loop);
void readPlausibility(YamlSection& root, LoopFile& loop);
void readStandstill(YamlSection& root, LoopFile& loop);

}  // namespace fpc
