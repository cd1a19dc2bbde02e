// This process goes on as another program.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "fmbpc/base/input_error.hpp"

namespace fpc::tool {

/// @param line path and arguments. @throws InputError if it does not start
[[noreturn]] inline void become(std::vector<std::string> line) {
  std::vector<char*> arguments;
  for (std::string& word : line) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(arguments.front(), arguments.data());
  throw InputError(line.front() + ": expected a program that starts (" + strerror(errno) + ")");
}

}  // namespace fpc::tool
