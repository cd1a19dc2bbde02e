// Shipped loops by the type of their controller, so that a test picks up a new type by itself.
#pragma once

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "config/loop_file.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {

/// For a loop of public records: the same under its plant's nominal disturbances.
inline Overrides withoutRecords(const std::string& loop) {
  return needsRecords(loop) ? Overrides{{"disturbance", "{}"}} : Overrides{};
}

/// The type that a loop's own text names; empty for an external plant and for loops that leave it
/// to the file they extend.
inline std::string typeNamedBy(const std::string& loop) {
  const YAML::Node text = YAML::LoadFile(findLoop(loop));
  const YAML::Node controller = text["controller"], plant = text["plant"];
  const bool external = plant && plant["type"] && plant["type"].Scalar() == "external";
  return controller && controller["type"] && !external ? controller["type"].Scalar() : "";
}

/// Those whose own text names the type, with a plant of ours; in alphabetical order, those of
/// public records last. All files are read once.
inline std::vector<std::string> loopsOfType(const std::string& type) {
  static const std::map<std::string, std::vector<std::string>> known = [] {
    std::map<std::string, std::vector<std::string>> all;
    for (const std::string& name : loopNames()) all[typeNamedBy(name)].push_back(name);
    for (auto& entry : all)
      std::stable_partition(entry.second.begin(), entry.second.end(),
                            [](const std::string& name) { return !needsRecords(name); });
    return all;
  }();
  const auto found = known.find(type);
  return found == known.end() ? std::vector<std::string>{} : found->second;
}

}  // namespace fpc
