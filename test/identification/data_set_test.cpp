#include "identification/data_set.hpp"
#include "config/structure_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace fuzzy_data_set_test {

Structure structureWith(const std::string& rest = "") {
  return parseStructure(
      "sample_time_s: 60\ntime: {column: t, unit: min}\n"
      "outputs: {y: {unit: m, plausible: [-100, 100]}}\ninputs: {u: {unit: V}}\n"
      "submodels: {y: {N_y: {y: 1}, N_u: {u: 1}}}\n" +
          rest,
      "test.yaml");
}

/// 20 rows one minute apart: y = k, u = k^2.
CsvTable table() {
  CsvTable t{"data.csv", {"t", "y", "u"}, {"min", "m", "V"}, Matrix(20, 3)};
  for (Eigen::Index k = 0; k < 20; ++k) {
    const auto v = static_cast<double>(k);
    t.values.row(k) << v, v, v * v;
  }
  return t;
}

std::string errorOf(const std::function<void(CsvTable&)>& spoil, const std::string& rest = "",
                    RowRange rows = {}) {
  CsvTable t = table();
  spoil(t);
  try {
    makeDataSet(t, structureWith(rest), rows);
  } catch (const InputError& e) {
    return e.what();
  }
  return "nothing was thrown";
}

bool contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
  return true;
}

TEST(DataSet, TakesColumnsOverRowsCountedFromOne) {
  const DataSet data = makeDataSet(table(), structureWith(), parseRows("3:14"));
  ASSERT_EQ(data.rows(), 12);
  EXPECT_EQ(data.values(0, 0), 2.0);
  EXPECT_EQ(data.values(11, 1), 169.0);
  EXPECT_EQ(data.outputs[0].lower, 2.0);
  EXPECT_EQ(data.outputs[0].upper, 13.0);
  EXPECT_TRUE(data.repairs.empty());
}

TEST(DataSet, RowsAreReadInAllForms) {
  EXPECT_EQ(parseRows("5001:7500").first, 5001);
  EXPECT_EQ(parseRows("5001:7500").last, 7500);
  EXPECT_EQ(parseRows(":7").first, 1);
  EXPECT_EQ(parseRows("7:").last, 0);
  for (const char* bad : {"7", "0:5", "5:4", "a:b", "1:2:3", "-1:5", "1.5:3"})
    EXPECT_THROW(parseRows(bad), InputError) << bad;
}

TEST(DataSet, RegressionRowsPairThePastWithTheNextOutput) {
  const DataSet data = makeDataSet(table(), structureWith());
  const Regression rows =
      makeRegression(data, {{SignalKind::kOutput, 0, 0}, {SignalKind::kInput, 0, 3}},
                     {{SignalKind::kInput, 0, 1}}, 0);
  ASSERT_EQ(rows.rows(), 16);  // k = 3..18
  EXPECT_EQ(rows.sample.front(), 3);
  EXPECT_EQ(rows.regressors(0, 0), 3.0);
  EXPECT_EQ(rows.regressors(0, 1), 0.0);
  EXPECT_EQ(rows.antecedents(0, 0), 4.0);
  EXPECT_EQ(rows.target[0], 4.0);
  EXPECT_EQ(rows.target[15], 19.0);
}

TEST(DataSet, MissingCellsAreAnErrorThatTellsWhere) {
  const auto spoil = [](CsvTable& t) { t.values(4, 1) = t.values(6, 1) = kNaN; };
  const std::string error = errorOf(spoil);
  contains(error, "column 'y'");
  contains(error, ", row 5: column 'y': expected no missing cells; 2 are");
}

TEST(DataSet, MissingCellsAreSteppedOverOrInterpolatedWhenAllowedAndCounted) {
  CsvTable t = table();
  t.values(4, 1) = t.values(5, 1) = kNaN;
  const DataSet dropped = makeDataSet(t, structureWith("repair: {missing: drop}\n"));
  EXPECT_TRUE(std::isnan(dropped.values(4, 0)));
  EXPECT_EQ(makeRegression(dropped, {{SignalKind::kOutput, 0, 0}}, {}, 0).rows(), 19 - 3);
  ASSERT_EQ(dropped.repairs.size(), 1U);
  contains(dropped.repairs[0], "2 missing cells of 'y' left out");
  const DataSet filled = makeDataSet(t, structureWith("repair: {missing: interpolate}\n"));
  EXPECT_NEAR(filled.values(4, 0), 4.0, 1e-12);
  EXPECT_NEAR(filled.values(5, 0), 5.0, 1e-12);
  contains(filled.repairs[0], "interpolated");
}

TEST(DataSet, ImplausibleCellsAreErrorsOrMendedAsSaidAndCounted) {
  CsvTable t = table();
  t.values(4, 1) = 999.0;
  const auto with = [&](const std::string& how) {
    Structure structure = structureWith();
    structure.outputs[0].implausible = how == "clip"          ? Implausible::kClip
                                       : how == "hold"        ? Implausible::kHold
                                       : how == "interpolate" ? Implausible::kInterpolate
                                                              : Implausible::kDrop;
    return makeDataSet(t, structure);
  };
  EXPECT_EQ(with("clip").values(4, 0), 100.0);
  EXPECT_EQ(with("hold").values(4, 0), 3.0);
  EXPECT_EQ(with("interpolate").values(4, 0), 4.0);
  EXPECT_TRUE(std::isnan(with("drop").values(4, 0)));
  contains(with("hold").repairs[0], "1 implausible cells of 'y' held");
  contains(errorOf([](CsvTable& spoiled) { spoiled.values(4, 1) = 999.0; }),
           ", row 5: column 'y': expected a value from -100 to 100 m");
}

TEST(DataSet, TheInputOfTheLastRowActsAfterTheDataAndMayBeMissing) {
  CsvTable t = table();
  t.values(19, 2) = kNaN;
  const DataSet data = makeDataSet(t, structureWith());
  EXPECT_TRUE(data.repairs.empty());
  EXPECT_EQ(makeRegression(data, {{SignalKind::kInput, 0, 0}}, {}, 0).rows(), 19);
  contains(errorOf([](CsvTable& spoiled) { spoiled.values(18, 2) = kNaN; }), ", row 19");
}

TEST(DataSet, ConstantColumnsAreRefusedOrDropped) {
  const auto spoil = [](CsvTable& t) { t.values.col(2).setConstant(7.0); };
  contains(errorOf(spoil), "column 'u': expected values that move");
  CsvTable t = table();
  spoil(t);
  const DataSet data = makeDataSet(t, structureWith("repair: {drop_constant: true}\n"));
  EXPECT_TRUE(data.constant[1]);
  contains(errorOf([](CsvTable& c) { c.values.col(1).setConstant(7.0); },
                   "repair: {drop_constant: true}\n"),
           "column 'y'");
}

TEST(DataSet, DuplicatedColumnsAreNamed) {
  contains(errorOf([](CsvTable& t) { t.values.col(2) = t.values.col(1); }),
           "column 'u': expected other values than column 'y'");
}

TEST(DataSet, ACellThatOverflowsTheFitIsNamed) {
  contains(errorOf([](CsvTable& t) { t.values(7, 2) = 1e300; }),
           "data.csv, row 8: column 'u': expected values of at most 1e60");
}

TEST(DataSet, AnotherUnitIsRefused) {
  contains(errorOf([](CsvTable& t) { t.units[1] = "mm"; }),
           "the unit [m] of the structure, got [mm]");
  contains(errorOf([](CsvTable& t) { t.values.col(1) *= 1000.0; }), "another unit?");
  contains(errorOf([](CsvTable& t) { t.units[0] = "s"; }), "column 't'");
}

TEST(DataSet, UnsortedTimesAreRefusedOrSorted) {
  const auto spoil = [](CsvTable& t) { t.values.row(3).swap(t.values.row(9)); };
  contains(errorOf(spoil), "repair.sort_time");
  CsvTable t = table();
  spoil(t);
  const DataSet data = makeDataSet(t, structureWith("repair: {sort_time: true}\n"));
  EXPECT_EQ(data.values, makeDataSet(table(), structureWith()).values);
  contains(data.repairs[0], "2 rows moved");
}

TEST(DataSet, UnequalTimesAreRefusedAndHolesBecomeMissingRows) {
  contains(errorOf([](CsvTable& t) { t.values(7, 0) += 0.3; }), "times 1 apart");
  contains(errorOf([](CsvTable& t) { t.values(7, 0) = t.values(6, 0); }), "column 't'");
  contains(errorOf([](CsvTable& t) {
             t.values.col(0) *= 60.0;
             t.units[0].clear();
           }),
           "another unit?");
  CsvTable t = table();
  t.values.col(0).tail(10).array() += 2.0;
  const DataSet data = makeDataSet(t, structureWith("repair: {missing: drop}\n"));
  EXPECT_EQ(data.rows(), 22);
  contains(data.repairs[0], "2 rows absent");
}

TEST(DataSet, ARecordOfAnotherSampleTimeIsNotOneWithMissingRows) {
  const auto slower = [](CsvTable& t) { t.values.col(0) *= 2.0; };
  contains(errorOf(slower),
           "times 1 apart (another unit? or another sample_time_s), got 2 from each row");
  contains(errorOf([&](CsvTable& t) {
             slower(t);
             t.values(19, 0) += 2.0;  // and a row lacks
           }),
           "got 2 from each row to the next, or multiples of it");
  CsvTable t = table();
  slower(t);
  EXPECT_EQ(makeDataSet(t, structureWith("repair: {missing: interpolate}\n")).rows(), 39)
      << "asked for";
}

TEST(DataSet, TimesThatRepeatAreNotToBeSorted) {
  const auto repeat = [](CsvTable& t) { t.values(7, 0) = t.values(6, 0); };
  for (const char* repair : {"", "repair: {sort_time: true}\n"})
    contains(errorOf(repeat, repair), "every time only once");
}

TEST(DataSet, DatesWithoutHyphensAreNoTimes) {
  contains(errorOf([](CsvTable& t) {
             for (Eigen::Index k = 0; k < t.rows(); ++k)
               t.values(k, 0) = 20250301.0 + static_cast<double>(k);
           }),
           "2025-03-01, got 20250301");
}

TEST(DataSet, TooFewRowsAndUnknownColumnsAreErrors) {
  contains(errorOf([](CsvTable&) {}, "", {1, 5}), "at least 10 rows, got 5");
  contains(errorOf([](CsvTable&) {}, "", {1, 21}), "rows within 1:20");
  contains(errorOf([](CsvTable& t) { t.names[2] = "v"; }), "'u'");
}

}  // namespace fuzzy_data_set_test
}  // namespace fpc
