// A text in parts.
#pragma once

#include <sstream>
#include <string>
#include <vector>

namespace fpc {

/// "a.b" at '.': a, b; none of an empty text, and none behind a last separator.
inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

}  // namespace fpc
