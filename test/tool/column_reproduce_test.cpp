// The rows of `fmbpc reproduce` for the column: which figures are reached, and which cannot be.
#include <gtest/gtest.h>

#include <cstdio>

#include "papers/experiment.hpp"
#include "papers/report.hpp"

namespace fpc::papers {
namespace tool_column_reproduce_test {

TEST(ColumnReproduction, ReachesEveryFigureButThoseOfThePrintedLoopTwo) {
  std::size_t count = 0, fits = 0;
  for (const Experiment& experiment : experiments()) {
    if (experiment.name < "column_table_3" || experiment.name > "column_table_5") continue;
    for (const Row& row : rowsOf(experiment)) {
      std::printf("%-14s %-28s %10.4g %10.4g %-14s %-16s %s\n", experiment.name.c_str(),
                  row.quantity.c_str(), row.paper, row.here.median(), row.unit.c_str(),
                  name(row.verdict()), row.note.c_str());
      const bool misprint = row.note.find("contradicts") != std::string::npos;
      EXPECT_TRUE(misprint || !isShort(row.verdict())) << row.quantity;
      EXPECT_NE(row.verdict(), Verdict::kNoResult) << row.quantity;
      EXPECT_FALSE(row.unit.empty());
      // what was fitted to these tables is not judged by them
      const bool fitted = remarkOf(row).find("fitted to") != std::string::npos;
      EXPECT_EQ(row.incomparable.empty(), !fitted) << row.quantity;
      if (fitted) ++fits;
      ++count;
    }
  }
  EXPECT_EQ(count, 8U + 2U * 5U * 4U);
  EXPECT_EQ(fits, 2U + 2U * 4U) << "lambda of two gains; loop 2 in both tables";
}

}  // namespace tool_column_reproduce_test
}  // namespace fpc::papers
