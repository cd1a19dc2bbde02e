// Ranges of signals in files.
#pragma once

#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

/// Both ends of a range that is not empty; without the key both stay, and it returns false.
inline bool readRange(YamlSection& section, const std::string& key, double& lower, double& upper,
                      Range allowed = {}) {
  const bool given = section.interval(key, lower, upper, allowed);
  if (given && !(lower < upper)) section.fail(key, "[lower, upper] with lower < upper");
  return given;
}

}  // namespace fpc
