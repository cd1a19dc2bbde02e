// A short name for a text, to tell whether it is still the same.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace fpc {

/// FNV-1a, in hexadecimal.
inline std::string textHash(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  char word[17];
  std::snprintf(word, sizeof word, "%016llx", static_cast<unsigned long long>(hash));
  return word;
}

}  // namespace fpc
