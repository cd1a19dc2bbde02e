// Lists of plants and controllers hold what the packages of the loops bring.
#include <fstream>

#include "config/loop_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "tool/commands.hpp"

namespace fpc::tool {
namespace {

bool namesPlugins(const std::string& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);)
    if (line.rfind("plugins:", 0) == 0) return true;
  return false;
}

}  // namespace

void loadPluginsOfLoops() {
  for (const auto& file : loopFiles()) {
    if (!namesPlugins(file)) continue;
    try {
      readLoop(file);
    } catch (const std::exception&) {  // `fmbpc loops` says why
    }
  }
}

}  // namespace fpc::tool
