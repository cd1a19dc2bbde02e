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

/// The text as the whole file, which is there as a whole or as it was: what is new, or a regular
/// file (also behind a link), is written beside and moved there; a device or a pipe is written to.
/// @throws InputError naming the file.
inline void writeText(const std::string& text, const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool replaces = fs::is_regular_file(file, error) || !fs::exists(file, error);
  const bool link = replaces && fs::is_symlink(file, error);
  const fs::path place = fs::path(file).parent_path();
  const fs::path target = !link                     ? fs::path(file)
                          : fs::exists(file, error) ? fs::canonical(file, error)
                                                    : place / fs::read_symlink(file, error);
  const fs::path written = replaces ? fs::path(target.string() + ".partial") : target;
  if (replaces) fs::remove(written, error);  // of a process that was killed
  std::ofstream stream(written);
  stream << text;
  stream.close();
  error.clear();
  if (replaces && !stream.fail()) fs::rename(written, target, error);
  const bool failed = stream.fail() || error;
  if (failed && replaces) fs::remove(written, error);
  require(!failed, file, "a writable file");
}

}  // namespace fpc
