// Which code the registered plants are made of. Private, for the loader of plugins.
#pragma once

#include <vector>

namespace fpc {

/// An address of each plant's factory, see codeAddress().
std::vector<const void*> plantCode();

}  // namespace fpc
