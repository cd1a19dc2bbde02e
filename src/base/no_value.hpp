// A measured value that must not be used: no number, which says why. It travels where only a number
// can.
#pragma once

#include <cstdint>

namespace fpc {

enum class NoValue : std::uint8_t { kNoNumber, kStale, kMissing };

/// A NaN with the reason in its payload.
double noValue(NoValue why);
/// The reason of a value that is no number; kNoNumber where nobody gave one.
NoValue whyNoValue(double value);

}  // namespace fpc
