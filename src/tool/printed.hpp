// What a program has printed must be there.
#pragma once

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace fpc::tool {

/// The exit code of a program that is about to end with `code`: 1 if stdout did not take all of it.
inline int printed(int code) {
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  std::fprintf(stderr, "fmbpc: stdout: expected room for all that is printed (%s)\n",
               std::strerror(errno == 0 ? EIO : errno));
  return code == 0 ? 1 : code;
}

}  // namespace fpc::tool
