// A file that is there as a whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

/// Writes `text` beside the file and moves it there. @throws InputError naming the file.
inline void replaceFile(const std::string& file, const std::string& text) {
  const std::string beside = file + ".new";
  std::ofstream stream(beside);
  stream << text;
  stream.close();
  std::error_code error;
  if (!stream.fail()) std::filesystem::rename(beside, file, error);
  require(!stream.fail() && !error, file, "a writable file");
}

}  // namespace fpc
