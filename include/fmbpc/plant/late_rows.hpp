// Rows of a record whose rounded times act a sample late.
#pragma once

#include "fmbpc/plant/disturbance.hpp"

namespace fpc {

/// A row acts from the first sample at or after its time (early by at most 1e-4 of an interval).
/// One whose time was rounded up past its sample acts from the next.
struct LateRows {
  std::uint64_t rows{};  ///< up to 2 % of a sample after one, and not early enough for it
  std::uint64_t of{};    ///< rows within the run, the first one of a file left out
  /// More than chance: records whose rows fall anywhere between samples have 2 % of such rows.
  bool isRounding() const { return rows >= 2 && 10 * rows >= of; }
};

/// As in disturbance.hpp, and adds to `late`; no row is late where they are interpolated.
DisturbanceRecord readDisturbances(const CsvDisturbanceParams& params,
                                   const std::vector<std::string>& names, const Vector& nominal,
                                   double sample_time_s, std::uint32_t samples, LateRows& late);
DisturbanceRecord readDisturbanceSequence(const CsvDisturbanceParams& params,
                                          const std::vector<std::string>& names,
                                          const Vector& nominal, double sample_time_s,
                                          std::uint32_t samples, LateRows& late);

}  // namespace fpc
