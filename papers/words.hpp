// Words of an expression as what they mean.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/input_error.hpp"

namespace fpc::papers {

/// @throws InputError unless the whole word is a number
double toNumber(const std::string& word);
inline std::size_t toIndex(const std::string& word) {
  return static_cast<std::size_t>(toNumber(word));
}
/// The place of a word among those that are known. @throws InputError listing them
std::size_t placeOf(const std::string& word, const std::vector<std::string>& known);

}  // namespace fpc::papers
