// What a YamlSection stands on. Private: yaml-cpp does not appear in public headers.
#pragma once

#include <yaml-cpp/yaml.h>

#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

struct YamlNode : YAML::Node {
  YamlNode(const YAML::Node& node) : YAML::Node(node) {}  // NOLINT: the same thing
};

}  // namespace fpc
