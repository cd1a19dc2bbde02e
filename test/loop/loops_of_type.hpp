// Shipped loops by the type of their controller, so that a test picks up a new type by itself.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "fmbpc/config/loop_file.hpp"
#include "loop/loop_fixture.hpp"

namespace fpc {

/// Those whose own text names the type, with a plant of ours and without public records; in
/// alphabetical order.
inline std::vector<std::string> loopsOfType(const std::string& type) {
  std::vector<std::string> loops;
  for (const std::string& name : loopNames()) {
    if (needsRecords(name)) continue;
    const YAML::Node text = YAML::LoadFile(findLoop(name));
    const YAML::Node controller = text["controller"], plant = text["plant"];
    if (!controller || !controller["type"] || controller["type"].Scalar() != type) continue;
    if (plant && plant["type"] && plant["type"].Scalar() == "external") continue;
    loops.push_back(name);
  }
  return loops;
}

}  // namespace fpc
