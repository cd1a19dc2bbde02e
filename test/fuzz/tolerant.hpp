// What a target may answer to nonsense: an InputError in words, nothing else.
#pragma once

#include <stdexcept>
#include <string>

#include "fmbpc/base/input_error.hpp"

namespace fpc::fuzz {

template <typename Read>
void tolerant(Read read) {
  try {
    read();
  } catch (const InputError& e) {
    if (std::string(e.what()).empty()) throw std::logic_error("an error without words");
  }
}

}  // namespace fpc::fuzz
