// Keys of earlier versions. Private to the room.
#pragma once

#include <string>

#include "fmbpc/base/yaml_section.hpp"

namespace fpc {

/// What could not be read may be a key that went: then its successor is named.
/// @throws InputError if the section of the error holds one.
void explainGoneKeys(const YamlSection& root, const std::string& error);

}  // namespace fpc
