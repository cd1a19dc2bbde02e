// A record against the plant: units that the header states, and values that the plant cannot take.
#include <gtest/gtest.h>

#include "config/disturbance_source.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_csv_checks_test {

class CsvChecks : public LoopFolder {
 protected:
  /// The record as T_in [degC] of the heated tank; `channel` is added to its channel.
  std::string errorFor(const std::string& text, const std::string& channel = "",
                       const std::string& time_unit = "h") {
    write("record.csv", text);
    const std::string file =
        write("loop.yaml",
              "extends: heated_tank\nsampling: {duration_h: 1}\ndisturbance:\n  source: csv\n"
              "  commands: []\n  csv:\n    file: record.csv\n    time_column: t\n    time_unit: " +
                  time_unit + "\n    channels: {T_in: {column: v" + channel + "}}\n");
    return errorOf([&] { makeDisturbance(readLoop(file)); });
  }
  std::string rows(const std::string& header, const std::string& bad = "16") {
    return header + "\n0,15\n0.5," + bad + "\n1,14\n";
  }
};

const char kRecordTaken[] = "nothing was thrown";

TEST_F(CsvChecks, AnotherUnitOfTimeThanTimeUnitIsRefused) {
  EXPECT_EQ(errorFor(rows("t[h],v")), kRecordTaken);
  EXPECT_EQ(errorFor(rows("t,v")), kRecordTaken);
  expectWords(errorFor(rows("t[min],v")), {path("record.csv") + ":1: column 't': expected [h]",
                                           "disturbance.csv.time_unit", "got [min]"});
  EXPECT_EQ(errorFor("t[min],v\n0,15\n30,16\n60,14\n", "", "min"), kRecordTaken);
  EXPECT_EQ(errorFor("t[UTC],v\n2026-01-01 00:00,15\n2026-01-01 01:00,16\n"), kRecordTaken)
      << "dates carry their own";
}

TEST_F(CsvChecks, AnotherUnitOfTheSignalNeedsAConversion) {
  expectWords(errorFor(rows("t,v[K]")),
              {path("record.csv") + ":1: column 'v': expected [degC], the unit of T_in, got [K]",
               "disturbance.csv.channels.T_in.scale, offset or mean"});
  EXPECT_EQ(errorFor("t,v[K]\n0,288\n1,289\n", ", offset: -273.15"), kRecordTaken);
  EXPECT_EQ(errorFor(rows("t,v[K]"), ", mean: 15"), kRecordTaken);
  expectWords(errorFor(rows("t,v"), ", mean: 0"), {"channels.T_in.mean", "a number other than 0"});
  EXPECT_EQ(errorFor(rows("t,v[Celsius]"), ", scale: 1"), kRecordTaken);
  EXPECT_NE(errorFor(rows("t,v[Celsius]")), kRecordTaken);
  for (const char* unit : {"degC", "\u00b0C", " deg C "})
    EXPECT_EQ(errorFor(rows(std::string("t,v[") + unit + "]")), kRecordTaken) << unit;
}

TEST_F(CsvChecks, AValueThatThePlantCannotTakeNamesItsRowAndTheKeyForMissingCells) {
  expectWords(
      errorFor(rows("t,v", "-999")),
      {path("record.csv") + ":3: column 'v': expected a cell that makes T_in >= 0 and <= 40",
       "got -999", "disturbance.csv.missing_values: [-999]"});
  expectWords(errorFor(rows("t,v", "50")), {":3: column 'v'", "got 50", ".plausible"});
  expectWords(errorFor(rows("t,v", "50"), ", scale: -1, offset: 40"), {":3: column 'v'", "got 50"});
}

}  // namespace config_csv_checks_test
}  // namespace fpc
