// Does the plant that introduces itself over a topic agree with the loop file?
#pragma once

#include <string>

#include "fmbpc/base/exchange.hpp"

namespace fpc {

/// Empty if `arrived` has the signals (names, order), units and sample time of `expected`;
/// otherwise the first difference in words. Bounds and frames may differ.
std::string plantMismatch(const PlantInfo& expected, const PlantInfo& arrived);

/// The first signal whose bounds are others than the loop file's, in words; empty if there is none.
/// Bounds that the loop file leaves open are not compared.
std::string boundsDifference(const PlantInfo& expected, const PlantInfo& arrived);

}  // namespace fpc
