// The tool as a person or a script calls it.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace fpc {

struct Outcome {
  int code{};
  std::string printed;
};

/// A line of the shell: its standard output.
inline Outcome shell(const std::string& line) {
  FILE* pipe = popen(line.c_str(), "r");
  Outcome outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.printed.append(buffer.data(), n);
  outcome.code = WEXITSTATUS(pclose(pipe));
  return outcome;
}

/// Standard output, or with `errors` standard error, of `fmbpc ARGUMENTS`.
inline Outcome tool(const std::string& arguments, bool errors = false) {
  const std::string redirect = errors ? " 2>&1 >/dev/null" : " 2>/dev/null";
  return shell(std::string(FMBPC_TOOL) + " " + arguments + redirect);
}

}  // namespace fpc
