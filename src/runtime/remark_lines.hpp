// Remarks of a sample: one a line. Private to the package.
#pragma once

#include <string>

namespace fpc {

inline std::string joinedLines(const std::string& first, const std::string& second) {
  return first.empty() || second.empty() ? first + second : first + "\n" + second;
}

/// For a log.
inline std::string inOneLine(std::string lines) {
  for (std::size_t at = 0; (at = lines.find('\n', at)) != std::string::npos;)
    lines.replace(at, 1, "; ");
  return lines;
}

}  // namespace fpc
