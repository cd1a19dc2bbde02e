// A vector as the list that files are written from.
#pragma once

#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

inline std::vector<double> listOf(const Vector& values) {
  return {values.data(), values.data() + values.size()};
}

}  // namespace fpc
