// Dates and clocks that would pass for numbers of seconds or hours.
#include "base/time_cells.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "error_words.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_time_cells_test {

std::string errorOf(const std::vector<double>& cells) {
  CsvTable table{"r.csv", {"t"}, {""}, Matrix(static_cast<Eigen::Index>(cells.size()), 1)};
  for (std::size_t i = 0; i < cells.size(); ++i)
    table.values(static_cast<Eigen::Index>(i), 0) = cells[i];
  return test::thrownBy([&] { requirePlainTimes(table, 0); });
}

using test::expectWords;
const std::string kNothing = "nothing was thrown";

// As numbers of days these would lie 1 and 73 apart.
TEST(TimeCells, DatesWithoutHyphensAreNoNumbers) {
  expectWords(errorOf({20250228, 20250301, 20250302}),
              "r.csv, row 1: column 't': expected times as numbers, or dates with hyphens, "
              "2025-02-28, got 20250228");
  expectWords(errorOf({202502282359, 202503010000}), "2025-02-28T23:59, got 202502282359");
  expectWords(errorOf({20250228235959, 20250301000000}), "2025-02-28T23:59:59, got 2025022823");
}

TEST(TimeCells, MillisecondsSince1970AreInNoUnit) {
  expectWords(errorOf({1740700800000, 1740704400000}), "milliseconds since 1970");
  expectWords(errorOf({1740700800000000000}), "milliseconds");
}

TEST(TimeCells, OtherNumbersAreTimes) {
  EXPECT_EQ(errorOf({20250228, 20250229, 20250230}), kNothing) << "no 29 February in 2025";
  EXPECT_EQ(errorOf({20250228, 20250228.5, 20250301}), kNothing);
  EXPECT_EQ(errorOf({18991231, 19000101}), kNothing) << "years from 1900 on";
  EXPECT_EQ(errorOf({1740700800, 1740704400}), kNothing) << "seconds since 1970";
  EXPECT_EQ(errorOf({0, 720, 1440}), kNothing);
  EXPECT_EQ(errorOf({-1, 0, 1}), kNothing);
  EXPECT_EQ(errorOf({kNaN, 1}), kNothing) << "told where it is read";
}

}  // namespace base_time_cells_test
}  // namespace fpc
