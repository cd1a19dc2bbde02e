// The times of a record: in another decimal, or rounded up past their samples.
#include "plant/disturbance.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace plant_csv_rows_test {

CsvDisturbanceParams paramsFor(const std::string& text) {
  CsvDisturbanceParams params;
  params.file = ::testing::TempDir() + "csv_rows_test.csv";
  std::ofstream(params.file, std::ios::binary) << text;
  params.time_column = "t";
  params.channels = {{"q_i", "q"}};
  return params;
}

std::string errorOf(const CsvDisturbanceParams& params) {
  try {
    readDisturbances(params, {"q_i"}, Vector::Constant(1, 1300.0), 1800.0, 1);
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

void expectWords(const std::string& error, const std::string& words) {
  EXPECT_NE(error.find(words), std::string::npos) << error;
}

TEST(CsvRows, TimesWithAnotherDecimalAreSuspected) {
  CsvDisturbanceParams params = paramsFor("t;q\n0,0;1\n0,5;2\n");
  params.format.separator = ';';
  expectWords(errorOf(params), "got '0,0' (decimal: point; is it comma?)");
  params.format.decimal = ',';
  EXPECT_EQ(errorOf(params), "nothing was thrown");
  params = paramsFor("t;q\n0.0;1\n0.5;2\n");
  params.format = {';', ',', {}};
  expectWords(errorOf(params), "got '0.0' (decimal: comma; is it point?)");
}

/// Rows of every 7.3 s, in days with so many digits behind the point.
LateRows lateRowsOf(int digits, double interval_s, Interpolation interpolation) {
  std::string text = "t,q\n";
  for (int k = 0; k < 60; ++k) {
    char row[64];
    std::snprintf(row, sizeof row, "%.*f,%d\n", digits, k * interval_s / 86400.0, k);
    text += row;
  }
  CsvDisturbanceParams params = paramsFor(text);
  params.time_unit = "d";
  params.interpolation = interpolation;
  return readDisturbances(params, {"q_i"}, Vector::Constant(1, 1300.0), 7.3, 40).late;
}

// Six digits of a day are 0.09 s: half of the rows are rounded up, past their sample.
TEST(CsvRows, ThoseThatRoundingPutBehindTheirSampleAreCounted) {
  const LateRows rounded = lateRowsOf(6, 7.3, Interpolation::kHold);
  EXPECT_EQ(rounded.of, 39U);
  EXPECT_GT(rounded.rows, 10U);
  EXPECT_LT(rounded.rows, 30U);
  EXPECT_TRUE(rounded.isRounding());
  EXPECT_EQ(lateRowsOf(10, 7.3, Interpolation::kHold).rows, 0U);
  EXPECT_EQ(lateRowsOf(6, 7.3, Interpolation::kLinear).rows, 0U);
  const LateRows drifting = lateRowsOf(10, 7.5, Interpolation::kHold);
  EXPECT_EQ(drifting.rows, 1U);  // row 37 at 38 samples and 0.1 s
  EXPECT_FALSE(drifting.isRounding());
}

}  // namespace plant_csv_rows_test
}  // namespace fpc
