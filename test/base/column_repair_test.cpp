#include "base/column_repair.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_column_repair_test {

struct Repaired {
  Vector cells;
  ColumnRepairs done;
  std::string error;
};

Repaired repaired(std::initializer_list<double> cells, const ColumnRules& rules) {
  Repaired result;
  result.cells = Eigen::Map<const Vector>(cells.begin(), static_cast<Eigen::Index>(cells.size()));
  const std::vector<double> times{0.0, 1.0, 3.0, 4.0, 8.0};
  try {
    result.done = repairColumn(result.cells, times, rules,
                               [](Eigen::Index r) { return "row " + std::to_string(r); });
  } catch (const InputError& e) {
    result.error = e.what();
  }
  return result;
}

ColumnRules rulesFor(MissingCells missing, Implausible implausible) {
  return {missing, 0.0, 100.0, implausible, "m", "repair.missing", "implausible"};
}

TEST(ColumnRepair, FillsOnStraightLinesInTimeBetweenMeasuredCells) {
  const auto line = repaired({kNaN, 10.0, kNaN, kNaN, 80.0},
                             rulesFor(MissingCells::kInterpolate, Implausible::kError));
  EXPECT_EQ(line.error, "");
  EXPECT_TRUE(line.cells.isApprox((Vector(5) << 10, 10, 30, 40, 80).finished())) << line.cells;
  EXPECT_EQ(line.done.missing, 4U - 1U);
  const auto held =
      repaired({10.0, kNaN, kNaN, 40.0, kNaN}, rulesFor(MissingCells::kHold, Implausible::kError));
  EXPECT_EQ(held.cells, (Vector(5) << 10, 10, 10, 40, 40).finished());
}

TEST(ColumnRepair, AnImplausibleCellIsNoNeighbour) {
  const auto mixed = repaired({10.0, 999.0, kNaN, kNaN, 80.0},
                              rulesFor(MissingCells::kInterpolate, Implausible::kHold));
  EXPECT_EQ(mixed.cells[1], 10.0);
  EXPECT_NEAR(mixed.cells[2], 10.0 + 70.0 * 3.0 / 8.0, 1e-12);
  EXPECT_EQ(mixed.done.missing, 2U);
  EXPECT_EQ(mixed.done.implausible, 1U);
}

TEST(ColumnRepair, ClippedCellsCountAsMeasured) {
  const auto clipped =
      repaired({10.0, 999.0, kNaN, -4.0, 80.0}, rulesFor(MissingCells::kHold, Implausible::kClip));
  EXPECT_EQ(clipped.cells, (Vector(5) << 10, 100, 100, 0, 80).finished());
  EXPECT_EQ(clipped.done.implausible, 2U);
}

TEST(ColumnRepair, SaysWhereAndWhichKeyHelps) {
  const auto missing =
      repaired({1.0, kNaN, kNaN, 2.0, 3.0}, rulesFor(MissingCells::kError, Implausible::kError));
  EXPECT_EQ(missing.error,
            "row 1: expected no missing cells; 2 are, this is the first (repair.missing says what "
            "to do)");
  const auto far =
      repaired({1.0, 2.0, 101.0, 2.0, 3.0}, rulesFor(MissingCells::kHold, Implausible::kError));
  EXPECT_EQ(far.error,
            "row 2: expected a value from 0 to 100 m (another unit? implausible says what to do), "
            "got 101");
  const auto nothing = repaired({kNaN, 999.0, kNaN, -1.0, kNaN},
                                rulesFor(MissingCells::kHold, Implausible::kInterpolate));
  EXPECT_EQ(nothing.error, "row 0: expected at least one number in the column");
}

}  // namespace base_column_repair_test
}  // namespace fpc
