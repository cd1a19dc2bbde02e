// The one exception for input that a person can correct: it names file, key and what was expected.
#pragma once

#include <stdexcept>
#include <string>

namespace fpc {

/// Thrown by readers, constructors and validate(); bad luck at run time is a status, never this.
class InputError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Throws InputError "<where>: expected <expected>" unless `condition` holds.
inline void require(bool condition, const std::string& where, const std::string& expected) {
  if (!condition) throw InputError(where + ": expected " + expected);
}

/// The same for literals: builds no string, and so allocates nothing, while the condition holds.
inline void require(bool condition, const char* where, const char* expected) {
  if (!condition) throw InputError(std::string(where) + ": expected " + expected);
}

}  // namespace fpc
