// Which column of a record holds its times, and what they say.
#pragma once

#include <string>
#include <vector>

#include "base/csv.hpp"

namespace fpc::tool {

struct TimeColumn {
  std::string name;  ///< empty: there is none
  std::string unit;  ///< s, min, h, d or ms; empty: neither the header nor the name tells
  double step_s{};   ///< the usual spacing; without a unit, as if it were in seconds
  /// Without a unit: the one with which the spacing is the sample time, if there is one.
  void fitTo(double sample_time_s);
};

/// `named`, or the first column not among `used` that rises evenly and is called a time (t, time,
/// timestamp, date, time (s), t_ms, ..; T, sec, hours if they always rise) or holds dates. Its
/// spacing is the mean of the steps that are whole multiples of their median, rounded to the
/// shortest number within 1e-4. No name: there is none.
/// @throws InputError naming file and column: none of that name, times that fall, steps further
/// than a quarter from their median or its multiples in more than a tenth of the rows, a strange
/// unit.
TimeColumn timeColumn(const CsvTable& table, const std::string& named,
                      const std::vector<std::string>& used);

/// @throws InputError naming file and column if one among `used` is a clock: called a time, and
/// always rising or falling.
void requireNoClock(const CsvTable& table, const std::vector<std::string>& used);

/// The table with equally spaced times where those of column `name` (empty: none) jitter by more
/// than rounding and less than a quarter of a sample, with a remark; otherwise as it is.
CsvTable withEvenTimes(CsvTable table, const std::string& name, std::vector<std::string>& remarks);

/// The table cut where the times of column `name` (empty: none) do not rise, a remark for each cut;
/// in one piece if a part would have fewer than 30 rows.
std::vector<CsvTable> piecesOf(const CsvTable& table, const std::string& name,
                               std::vector<std::string>& remarks);

}  // namespace fpc::tool
