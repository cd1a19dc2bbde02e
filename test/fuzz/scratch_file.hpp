// A file of this process, for readers that want a path.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace fpc::fuzz {

inline std::string scratchFile(const char* ending) {
  const auto name = "fmbpc_fuzz_" + std::to_string(getpid()) + ending;
  return (std::filesystem::temp_directory_path() / name).string();
}

}  // namespace fpc::fuzz
