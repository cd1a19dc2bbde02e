#include "paths.hpp"

namespace fpc {

std::string sourceDir() { return FMBPC_SOURCE_DIR; }
std::string resultsDir() { return FMBPC_RESULTS_DIR; }

}  // namespace fpc
