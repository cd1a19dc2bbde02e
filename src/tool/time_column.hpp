// Which column of a record holds its times, and what they say.
#pragma once

#include <string>
#include <vector>

#include "fmbpc/base/csv.hpp"

namespace fpc::tool {

struct TimeColumn {
  std::string name;  ///< empty: there is none
  std::string unit;  ///< s, min, h or d; empty: neither the header nor the name tells
  double step_s{};   ///< the usual spacing; without a unit, as if it were in seconds
  /// Without a unit: the one with which the spacing is the sample time, if there is one.
  void fitTo(double sample_time_s);
};

/// `named`, or the first column not among `used` that is called a time (time, t, time_...), or
/// t_something that rises evenly.
/// @throws InputError naming file and column: none of that name, times that do not rise evenly, a
/// strange unit.
TimeColumn timeColumn(const CsvTable& table, const std::string& named,
                      const std::vector<std::string>& used);

}  // namespace fpc::tool
