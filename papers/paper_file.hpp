// Where the data of the papers lie.
#pragma once

#include <string>

namespace fpc::papers {

/// papers/NAME.yaml of the sources, or as installed beside the configuration. @throws InputError
/// without it.
std::string paperFile(const std::string& name);

}  // namespace fpc::papers
