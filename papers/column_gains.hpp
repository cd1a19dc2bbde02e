// The changed gains of table 1 (mekki) on the plant, for the rows and the pictures of figures 6
// to 8.
#pragma once

#include <array>
#include <string>

#include "papers/runs.hpp"

namespace fpc::tool {

/// Gains of table 1, in the order 11, 12, 21, 22 [mol%/(lb/min)].
struct ColumnGains {
  const char* name;
  double values[4];
};
inline constexpr ColumnGains kNominalGains{"nominal", {12.8, -18.9, 6.6, -19.4}},
    kMaxGains{"Max", {15.36, -15.12, 7.92, -15.52}},
    kMinGains{"Min", {10.24, -22.68, 5.28, -23.28}};
inline constexpr std::array<const ColumnGains*, 2> kChangedGains{&kMaxGains, &kMinGains};

/// Loop 2 as it must be for tables 4 and 5: fitted to them.
const Overrides& fittedBottomLoop();
/// The plant has these gains from the start and nobody is told; `feed`: with the feed step of the
/// figure. Without the fit of loop 2 added: for loops that have settings of their own.
Overrides withGains(const ColumnGains& gains, bool feed);

}  // namespace fpc::tool
