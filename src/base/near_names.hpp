// What somebody may have meant, for the end of an error.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "fmbpc/base/text.hpp"

namespace fpc {

inline std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// "; near: a, b", or where no name is near "; " and what to do instead.
inline std::string nearNames(const std::string& word, const std::vector<std::string>& known,
                             const std::string& otherwise) {
  const auto near = nearest(word, known);
  return "; " + (near.empty() ? otherwise : "near: " + join(near));
}

inline constexpr char kLoopsListsThem[] = "`fmbpc loops` lists them";

}  // namespace fpc
