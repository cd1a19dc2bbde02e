// Where the tests find the project's own files, and where they may write. One unit knows it, so
// that all others compile the same in every folder.
#pragma once

#include <string>

namespace fpc {

std::string sourceDir();   ///< top of the source tree
std::string resultsDir();  ///< exists while the tests run

}  // namespace fpc
