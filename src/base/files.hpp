// Folders and files of results.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// Makes it and those above it, where they are missing. @throws InputError naming it.
inline void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  require(!error, folder.string(), "a folder that can be made (" + error.message() + ")");
}

inline std::string inFolder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

/// The text as the whole file. @throws InputError naming the file.
inline void writeText(const std::string& text, const std::string& file) {
  std::ofstream stream(file);
  stream << text;
  stream.close();
  require(!stream.fail(), file, "a writable file");
}

}  // namespace fpc
