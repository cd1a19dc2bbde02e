#include "tool/ranks.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace fpc::tool {
namespace {

/// Of Open MPI's mpirun.
int rankVariable(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::atoi(text);
}

}  // namespace

bool becomeMpi(char** arguments) {
  const std::string command = arguments[1] == nullptr ? "" : arguments[1];
  if (command != "study" && command != "tune") return true;
  if (rankVariable("OMPI_COMM_WORLD_SIZE") < 2) return true;
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string program = (self.parent_path() / "fmbpc_mpi").string();
  execv(program.c_str(), arguments);
  if (rankVariable("OMPI_COMM_WORLD_RANK") == 0)
    std::fprintf(stderr,
                 "fmbpc: several ranks, but built without Open MPI: no %s (Debian: libopenmpi-dev, "
                 "then configure and build again)\n",
                 program.c_str());
  return false;
}

}  // namespace fpc::tool
