#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "error_words.hpp"
#include "fmbpc/base/input_error.hpp"
#include "plant/disturbance.hpp"

namespace fpc {
namespace plant_disturbance_csv_test {

const std::vector<std::string> kNames{"q_i", "s_i"};
const Vector kNominal = Eigen::Vector2d(1300.0, 366.67);

std::string fileWith(const std::string& text) {
  const std::string file = ::testing::TempDir() + "disturbance_csv_test.csv";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

/// Column `q` as q_i, column `t` in hours.
CsvDisturbanceParams flowFrom(const std::string& text) {
  CsvDisturbanceParams params;
  params.file = fileWith(text);
  params.time_column = "t";
  params.channels = {{"q_i", "q"}};
  return params;
}

/// q_i at samples 0..`samples`, every half hour unless said.
std::vector<double> flows(const CsvDisturbanceParams& params, std::uint32_t samples,
                          double sample_time_s = 1800.0) {
  const Matrix values = readDisturbances(params, kNames, kNominal, sample_time_s, samples).values;
  EXPECT_EQ(values.row(1), Matrix::Constant(1, values.cols(), 366.67)) << "s_i is not in the file";
  const Vector row = values.row(0);
  return {row.data(), row.data() + row.size()};
}

std::string errorOf(const CsvDisturbanceParams& params, std::uint32_t samples = 2) {
  return test::thrownBy([&] { readDisturbances(params, kNames, kNominal, 1800.0, samples); });
}

using test::expectWords;

using Values = std::vector<double>;
const std::string kThreeHours = "t[h],q\n5,100\n6,200\n7,400\n";

TEST(DisturbanceCsv, HoldsEachRowUntilTheNextAndStartsWithTheFirst) {
  EXPECT_EQ(flows(flowFrom(kThreeHours), 5), (Values{100, 100, 200, 200, 400, 400}));
}

TEST(DisturbanceCsv, InterpolatesBetweenRows) {
  CsvDisturbanceParams params = flowFrom(kThreeHours);
  params.interpolation = Interpolation::kLinear;
  EXPECT_EQ(flows(params, 5), (Values{100, 150, 200, 300, 400, 400}));
}

TEST(DisturbanceCsv, ScalesAndShifts) {
  CsvDisturbanceParams params = flowFrom(kThreeHours);
  params.channels[0].scale = 2.0;
  params.channels[0].offset = 1.0;
  EXPECT_EQ(flows(params, 2), (Values{201, 201, 401}));
}

TEST(DisturbanceCsv, ScalesToAWantedMeanOfTheMeasuredCells) {
  CsvDisturbanceParams params = flowFrom("t,q\n0,100\n1,\n2,300\n");
  params.missing = MissingCells::kHold;
  params.channels[0].mean = 1000.0;
  EXPECT_EQ(flows(params, 4), (Values{500, 500, 500, 500, 1500}));
}

TEST(DisturbanceCsv, EveryTimeUnitIsUnderstood) {
  for (const auto& [unit, step] :
       {std::pair<const char*, double>{"s", 3600.0}, {"min", 60.0}, {"h", 1.0}}) {
    CsvDisturbanceParams params =
        flowFrom("t,q\n0,1\n" + std::to_string(step) + ",2\n" + std::to_string(2 * step) + ",3\n");
    params.time_unit = unit;
    EXPECT_EQ(flows(params, 4), (Values{1, 1, 2, 2, 3})) << unit;
  }
}

TEST(DisturbanceCsv, DatesAreDays) {
  CsvDisturbanceParams params = flowFrom("t,q\n1990-02-28,1\n1990-03-01,2\n1990-03-02,3\n");
  params.time_unit = "d";
  EXPECT_EQ(flows(params, 5, 43200.0), (Values{1, 1, 2, 2, 3, 3}));
  params.time_unit = "h";
  EXPECT_EQ(flows(params, 5, 43200.0), (Values{1, 1, 2, 2, 3, 3})) << "dates carry their unit";
}

TEST(DisturbanceCsv, TimesOfIso8601AreRead) {
  for (const char* text : {"t,q\n2026-03-28 22:00,1\n2026-03-28 23:00,2\n2026-03-29 00:00,3\n",
                           "t,q\n2026-03-29T00:30:00+01:00,1\n2026-03-29T00:30:00Z,2\n"
                           "2026-03-28T21:30:00-04:00,3\n"})
    EXPECT_EQ(flows(flowFrom(text), 5), (Values{1, 1, 2, 2, 3, 3})) << text;
  EXPECT_EQ(flows(flowFrom("t,q\n29.03.2026 01:00,1\n29.03.2026 02:00,2\n"), 3),
            (Values{1, 1, 2, 2}));
  expectWords(errorOf(flowFrom("t,q\n29/2026 01:00,1\n29/2026 02:00,2\n")),
              ":2: column 't': expected");
}

// Clocks go forward at two in the morning: local times lack an hour, a logger that was off two
// days.
TEST(DisturbanceCsv, AHoleInTimeIsMissingRows) {
  std::string text = "t,q\n";
  for (int hour = 0; hour < 24; ++hour)
    if (hour != 2)
      text += "2026-03-29 " + std::to_string(hour / 10) + std::to_string(hour % 10) + ":00," +
              std::to_string(100 + 10 * hour) + "\n";
  CsvDisturbanceParams params = flowFrom(text);
  expectWords(errorOf(params, 4),
              ":3: column 'q': the time jumps after this row: expected no missing");
  params.missing = MissingCells::kHold;
  EXPECT_EQ(flows(params, 3, 3600.0), (Values{100, 110, 110, 130}));
  params.missing = MissingCells::kInterpolate;
  EXPECT_EQ(flows(params, 3, 3600.0), (Values{100, 110, 120, 130}));
  EXPECT_EQ(readDisturbances(params, kNames, kNominal, 3600.0, 3).repaired, 1U);
  params = flowFrom("t,q\n0,1\n1,2\n2,3\n50,4\n51,5\n");
  params.missing = MissingCells::kHold;
  EXPECT_EQ(readDisturbances(params, kNames, kNominal, 3600.0, 51).repaired, 47U);
  expectWords(errorOf(flowFrom("t,q\n0,1\n1,2\n2,3\n1e9,4\n")), "rows (another unit?)");
  expectWords(errorOf(flowFrom("t,q\n20250228,1\n20250301,2\n")), "2025-02-28, got 20250228");
}

TEST(DisturbanceCsv, OtherSeparatorsDecimalsAndMissingValues) {
  CsvDisturbanceParams params =
      flowFrom("t[h];q;w\r\n0,0;1,5;Bad\r\n1,0;-999;null\r\n2,0;3,5;#N/A\r\n");
  expectWords(errorOf(params), "is it semicolon?");
  params.format.separator = ';';
  expectWords(errorOf(params), "is it comma?");
  params.format.decimal = ',';
  params.missing = MissingCells::kHold;
  EXPECT_EQ(flows(params, 2, 3600.0), (Values{1.5, -999, 3.5}));
  params.format.missing_values = {"-999", "Bad", "null", "#N/A"};
  EXPECT_EQ(flows(params, 2, 3600.0), (Values{1.5, 1.5, 3.5}));
  CsvDisturbanceParams tabs = flowFrom("t\tq\n0\t1\n1\t2\n");
  tabs.format.separator = '\t';
  EXPECT_EQ(flows(tabs, 1, 3600.0), (Values{1, 2}));
}

TEST(DisturbanceCsv, ImplausibleCellsAreMissingOnesAndCounted) {
  CsvDisturbanceParams params = flowFrom("t,q\n0,100\n1,9999\n2,300\n3,-5\n4,\n5,600\n");
  params.channels[0].lower = 0.0;
  params.channels[0].upper = 1000.0;
  expectWords(errorOf(params, 4), ":3: column 'q': expected a value from 0 to 1000");
  expectWords(errorOf(params, 4), "disturbance.csv.missing");
  params.missing = MissingCells::kHold;
  EXPECT_EQ(flows(params, 5, 3600.0), (Values{100, 100, 300, 300, 300, 600}));
  params.missing = MissingCells::kInterpolate;
  EXPECT_EQ(flows(params, 5, 3600.0), (Values{100, 200, 300, 400, 500, 600}));
  const DisturbanceRecord record = readDisturbances(params, kNames, kNominal, 3600.0, 5);
  EXPECT_EQ(record.implausible, 2U);
  EXPECT_EQ(record.repaired, 1U);
}

// 15 minutes are 0.010416667 d in the file: 29 microseconds late for the sample, which must not see
// the row before.
TEST(DisturbanceCsv, RoundedTimesDoNotShiftTheRecordByARow) {
  CsvDisturbanceParams params =
      flowFrom("t,q\n0.000000000,1\n0.010416667,2\n0.020833333,3\n0.031250000,4\n");
  params.time_unit = "d";
  EXPECT_EQ(flows(params, 4, 900.0), (Values{1, 2, 3, 4, 4}));
}

TEST(DisturbanceCsv, MissingCellsAreHeldInterpolatedAndCounted) {
  const std::string text = "t,q\n0,\n1,100\n2,\n3,\n5,500\n6,nan\n";
  CsvDisturbanceParams params = flowFrom(text);
  params.missing = MissingCells::kHold;
  EXPECT_EQ(flows(params, 6, 3600.0), (Values{100, 100, 100, 100, 100, 500, 500}));
  params.missing = MissingCells::kInterpolate;
  EXPECT_EQ(flows(params, 6, 3600.0), (Values{100, 100, 200, 300, 400, 500, 500}))
      << "the row at 4 h is missing as well";
  EXPECT_EQ(readDisturbances(params, kNames, kNominal, 3600.0, 6).repaired, 5U);
}

TEST(DisturbanceCsv, MissingCellsAreErrorsUnlessAllowed) {
  expectWords(errorOf(flowFrom("t,q\n0,1\n1,\n2,3\n")),
              ":3: column 'q': expected no missing cells");
  CsvDisturbanceParams nothing = flowFrom("t,q\n0,\n1,\n");
  nothing.missing = MissingCells::kHold;
  expectWords(errorOf(nothing), "at least one number");
}

TEST(DisturbanceCsv, ARecordThatIsTooShortIsAnErrorUnlessHeldOrRepeated) {
  CsvDisturbanceParams params = flowFrom(kThreeHours);
  EXPECT_EQ(flows(params, 6).back(), 400.0) << "the last row acts for an hour like those before";
  expectWords(errorOf(params, 7), "a record of at least 3.5 h");
  params.end = RecordEnd::kHold;
  EXPECT_EQ(flows(params, 8), (Values{100, 100, 200, 200, 400, 400, 400, 400, 400}));
  params.end = RecordEnd::kRepeat;
  EXPECT_EQ(flows(params, 8), (Values{100, 100, 200, 200, 400, 400, 100, 100, 200}));
  params.interpolation = Interpolation::kLinear;
  EXPECT_EQ(flows(params, 8), (Values{100, 150, 200, 300, 400, 250, 100, 150, 200}));
}

TEST(DisturbanceCsv, ALastRowEqualToTheFirstClosesThePeriod) {
  CsvDisturbanceParams params = flowFrom("t,q\n0,100\n1,200\n2,400\n3,100\n");
  params.end = RecordEnd::kRepeat;
  EXPECT_EQ(flows(params, 7, 3600.0), (Values{100, 200, 400, 100, 200, 400, 100, 200}));
}

TEST(DisturbanceCsv, TimesMustBeThereAndIncrease) {
  expectWords(errorOf(flowFrom("t,q\n0,1\n1,2\n1,3\n")),
              ":4: column 't': expected increasing times, got 1 after 1");
  expectWords(errorOf(flowFrom("t,q\n0,1\n2,2\n1,3\n")),
              ":4: column 't': expected increasing times, got 1 after 2");
  expectWords(errorOf(flowFrom("t,q\n0,1\n,2\n")), ":3: column 't': expected a time");
  expectWords(errorOf(flowFrom("t,q\n0,1\n")), "at least two rows");
}

TEST(DisturbanceCsv, BadNamesAndChoicesAreErrors) {
  const auto spoiled = [](auto spoil) {
    CsvDisturbanceParams params = flowFrom(kThreeHours);
    spoil(params);
    return errorOf(params);
  };
  using P = CsvDisturbanceParams;
  expectWords(spoiled([](P& p) { p.file += ".gone"; }), ".gone: expected a readable file");
  expectWords(spoiled([](P& p) { p.time_column = "time"; }), "column 'time': expected one of t, q");
  expectWords(spoiled([](P& p) { p.channels[0].column = "Q"; }),
              "column 'Q': expected one of t, q");
  expectWords(spoiled([](P& p) { p.channels[0].name = "x"; }), "'x': expected one of q_i, s_i");
  expectWords(spoiled([](P& p) { p.channels.push_back(p.channels[0]); }), "only once");
  expectWords(spoiled([](P& p) { p.time_unit = "hours"; }), "disturbance.csv.time_unit");
  expectWords(spoiled([](P& p) { p.missing = MissingCells::kDrop; }), "disturbance.csv.missing");
  expectWords(spoiled([](P& p) { p.channels[0].scale = NAN; }), "finite scale");
  expectWords(errorOf(flowFrom(kThreeHours), 0), "duration");
}

std::string dataFile(const std::string& name) {
  const char* folder = std::getenv("FMBPC_DATA");
  return folder == nullptr ? "" : std::string(folder) + "/" + name;
}

// Benchmark simulation model no. 1, dry weather: 14 days every 15 min; the last row repeats the
// first, 14 days later.
TEST(DisturbanceCsv, ReadsThePublicBsm1Influent) {
  CsvDisturbanceParams params;
  params.file = dataFile("bsm1_influent_dry.csv");
  if (params.file.empty()) GTEST_SKIP() << "FMBPC_DATA, the folder of public records, is not set";
  params.time_column = "t_d";
  params.time_unit = "d";
  params.end = RecordEnd::kRepeat;
  params.channels = {{"q_i", "Q_m3d", 1.0, 0.0, 1300.0}, {"s_i", "COD_total", 1.0, 0.0, 366.67}};
  const DisturbanceRecord record = readDisturbances(params, kNames, kNominal, 900.0, 2 * 1344);
  EXPECT_EQ(record.repaired, 0U);
  EXPECT_NEAR(record.values.row(0).head(1344).mean(), 1300.0, 1.0);
  EXPECT_NEAR(record.values.row(1).head(1344).mean(), 366.67, 0.5);
  EXPECT_NEAR(record.values(0, 1) / record.values(0, 0), 21474.0 / 21477.0, 1e-12);
  EXPECT_EQ(record.values.col(0), record.values.col(1344));
  EXPECT_EQ(record.values.leftCols(1344), record.values.middleCols(1344, 1344));
  EXPECT_GT(record.values.minCoeff(), 0.0);
}

// A real plant near Barcelona, daily over 668 calendar days: 159 of the flows and 150 of the COD
// values are missing.
TEST(DisturbanceCsv, ReadsTheUciPlantWithItsGaps) {
  CsvDisturbanceParams params;
  params.file = dataFile("uci_wwtp_disturbance_calendar.csv");
  if (params.file.empty()) GTEST_SKIP() << "FMBPC_DATA, the folder of public records, is not set";
  params.time_column = "date";
  params.time_unit = "d";
  params.channels = {{"q_i", "q_i_m3h"}, {"s_i", "DQO_D_mgl"}};
  EXPECT_THROW(readDisturbances(params, kNames, kNominal, 3600.0, 168), InputError);
  for (const MissingCells repair : {MissingCells::kHold, MissingCells::kInterpolate}) {
    params.missing = repair;
    const DisturbanceRecord record = readDisturbances(params, kNames, kNominal, 86400.0, 667);
    EXPECT_EQ(record.repaired, 159U + 150U) << static_cast<int>(repair);
    EXPECT_EQ(record.values(0, 0), 1717.92);
    EXPECT_EQ(record.values(1, 1), 368.0);
    EXPECT_EQ(record.values(0, 667), 1313.5);
    EXPECT_TRUE(record.values.allFinite() && record.values.minCoeff() > 0.0)
        << static_cast<int>(repair);
  }
}

TEST(DisturbanceCsv, TimesOfAnotherUnitThanSaidAreRefused) {
  const std::string rows = ",q\n0,100\n60,200\n120,400\n";
  CsvDisturbanceParams params = flowFrom("t[min]" + rows);
  for (const char* word : {"column 't'", "[h]", "disturbance.csv.time_unit", "got [min]"})
    expectWords(errorOf(params), word);
  params.time_unit = "min";
  EXPECT_EQ(flows(params, 3), (Values{100, 100, 200, 200}));
  params = flowFrom("t[minutes]" + rows);
  params.time_unit = "min";
  EXPECT_EQ(flows(params, 3), (Values{100, 100, 200, 200}));
  params = flowFrom("t[ms]" + rows);
  params.time_unit = "s";
  expectWords(errorOf(params), "got [ms]");
}

}  // namespace plant_disturbance_csv_test
}  // namespace fpc
