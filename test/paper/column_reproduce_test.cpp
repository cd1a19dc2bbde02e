// The rows of `fmbpc reproduce` for the column: which figures are reached, and which cannot be.
#include <gtest/gtest.h>

#include <cstdio>

#include "tool/reproduce/column.hpp"

namespace fpc::tool {
namespace {

TEST(ColumnReproduction, ReachesEveryFigureButThoseOfThePrintedLoopTwo) {
  const auto rows = reproduceColumn();
  ASSERT_EQ(rows.size(), 8U + 10U * 4U);
  for (const ColumnRow& row : rows) {
    std::printf("%-18s %-8s %-5s %10.4g %10.4g %-12s %-16s %s\n", row.name.c_str(),
                row.source.c_str(), row.quantity.c_str(), row.paper, row.here, row.unit.c_str(),
                row.verdict.c_str(), row.note.c_str());
    const bool misprint = row.note.find("as printed") != std::string::npos ||
                          row.note.find("contradicts") != std::string::npos;
    if (!misprint) EXPECT_NE(row.verdict, "not reproducible") << row.name << ' ' << row.quantity;
    EXPECT_FALSE(row.unit.empty());
    if (row.verdict == "not reproducible") EXPECT_FALSE(row.note.empty());
  }
}

}  // namespace
}  // namespace fpc::tool
