// YAML text as a tree that is safe to walk: one document, of bounded depth and size. Private, as
// yaml_section.hpp.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace fpc {

/// @throws InputError naming `name` and the line: no valid YAML, a second document, more than a
/// hundred levels or a million nodes (aliases count as often as they are named).
YAML::Node loadYaml(const std::string& text, const std::string& name);

/// A copy in which no two places share a node, so that writing to one leaves all others alone. The
/// copy knows no line numbers.
YAML::Node detached(const YAML::Node& node);

}  // namespace fpc
