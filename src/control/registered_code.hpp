// Which code the registered controllers are made of. Private, for the loader of plugins.
#pragma once

#include <vector>

namespace fpc {

/// An address of each type's reader, see codeAddress().
std::vector<const void*> controllerCode();

}  // namespace fpc
