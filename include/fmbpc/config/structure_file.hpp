// Structure files: what a user states before identification, as YAML.
#pragma once

#include <string>

#include "fmbpc/fuzzy/structure.hpp"

namespace fpc {

/// Keys: docs/identification.md. @throws InputError naming file, line and key.
Structure readStructure(const std::string& file);
Structure parseStructure(const std::string& text, const std::string& name);

}  // namespace fpc
