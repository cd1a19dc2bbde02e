#include "base/csv.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "base/csv_header.hpp"
#include "error_words.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace base_csv_test {

std::string fileWith(const std::string& text) {
  const std::string file = ::testing::TempDir() + "csv_test.csv";
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

CsvTable tableOf(const std::string& text) { return readCsv(fileWith(text)); }

std::string errorOf(const std::string& text) {
  return test::thrownBy([&] { tableOf(text); });
}

TEST(Csv, ReadsNamesUnitsAndNumbers) {
  const CsvTable table = tableOf("time[h],x[mg/l],y\n0,1.5,+2\n0.2,-1e3,.5\n");
  EXPECT_EQ(table.names, (std::vector<std::string>{"time", "x", "y"}));
  EXPECT_EQ(table.units, (std::vector<std::string>{"h", "mg/l", ""}));
  ASSERT_EQ(table.rows(), 2);
  EXPECT_EQ(table.values(0, 1), 1.5);
  EXPECT_EQ(table.values(0, 2), 2.0);
  EXPECT_EQ(table.values(1, 1), -1000.0);
  EXPECT_EQ(table.values(1, 2), 0.5);
  EXPECT_EQ(table.column("y"), 2);
}

TEST(Csv, AnUnknownColumnIsReportedWithTheKnownOnes) {
  const CsvTable table = tableOf("a,b\n1,2\n");
  try {
    table.column("c");
    FAIL() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("one of a, b"), std::string::npos) << e.what();
  }
}

TEST(Csv, EmptyAndNanCellsAreMissing) {
  const CsvTable table = tableOf("a,b\n,1\nnan,2\n 3 ,NaN\n");
  EXPECT_TRUE(std::isnan(table.values(0, 0)));
  EXPECT_TRUE(std::isnan(table.values(1, 0)));
  EXPECT_EQ(table.values(2, 0), 3.0);
  EXPECT_EQ(table.missing(0), 2);
  EXPECT_EQ(table.missing(1), 1);
}

TEST(Csv, InfiniteAndMalformedNumbersAreErrorsWithLineAndColumn) {
  for (const char* cell :
       {"inf", "-inf", "infinity", "1e999", "1.2.3", "+-5", "1;2", "0x10", "--"}) {
    const std::string error = errorOf("a,b\n1,2\n3," + std::string(cell) + "\n");
    EXPECT_NE(error.find(":3: column 'b'"), std::string::npos) << error;
    EXPECT_NE(error.find(cell), std::string::npos) << error;
  }
}

TEST(Csv, ColumnsOfTextAreKeptAsMissing) {
  const CsvTable table = tableOf("a,comment\n1,rain\n2,\n");
  EXPECT_EQ(table.missing(1), 2);
}

TEST(Csv, CarriageReturnsByteOrderMarkQuotesAndEmptyLinesAreAccepted) {
  const CsvTable table = tableOf("\xEF\xBB\xBF\"t[h]\",\"x\"\r\n0,1\r\n\r\n1,2\r\n\r\n   \n");
  EXPECT_EQ(table.names, (std::vector<std::string>{"t", "x"}));
  EXPECT_EQ(table.units.front(), "h");
  ASSERT_EQ(table.rows(), 2);
  EXPECT_EQ(table.values(1, 1), 2.0);
}

TEST(Csv, TheLastLineNeedsNoLineEnd) { EXPECT_EQ(tableOf("a,b\n1,2\n3,4").values(1, 1), 4.0); }

TEST(Csv, DatesBecomeDaysSince1970) {
  const CsvTable table = tableOf("date,x\n1970-01-01,0\n2000-02-29,0\n2000-03-01,0\n");
  EXPECT_EQ(table.values(0, 0), 0.0);
  EXPECT_EQ(table.values(1, 0), 11016.0);
  EXPECT_EQ(table.values(2, 0), 11017.0);
  EXPECT_EQ(table.is_date, (std::vector<bool>{true, false}));
}

TEST(Csv, TimesOfIso8601BecomeDays) {
  const CsvTable table =
      tableOf("t\n1970-01-02T12:00\n1970-01-02 12:00:30\n1970-01-02T12:00:30.25\n1970-01-02\n");
  EXPECT_EQ(table.values(0, 0), 1.5);
  EXPECT_NEAR(table.values(1, 0), 1.5 + 30.0 / 86400.0, 1e-15);
  EXPECT_NEAR(table.values(2, 0), 1.5 + 30.25 / 86400.0, 1e-15);
  EXPECT_EQ(table.values(3, 0), 1.0);
  const CsvTable zoned = tableOf(
      "t\n1970-01-01T00:00Z\n1970-01-01T02:00+02:00\n1970-01-01T02:00+0200\n"
      "1969-12-31T22:00-02\n");
  EXPECT_TRUE(zoned.values.isZero(0.0)) << zoned.values;
  EXPECT_NE(errorOf("t\n1970-01-01T00:00Z\n1970-01-01T01:00\n").find(":3: column 't'"),
            std::string::npos);
  for (const char* bad :
       {"1970-01-01T24:00", "1970-01-01T00:60", "1970-01-01T00:00:60", "1970-1-1", "1970-01-01T",
        "1970-01-01T00:00+", "1970-01-01 00:00 UTC", "1970-01-01T00:00:00.", "1970-02-30T00:00"})
    EXPECT_NE(errorOf("t\n1970-01-01\n" + std::string(bad) + "\n").find(":3: column 't'"),
              std::string::npos)
        << bad;
}

TEST(Csv, QuotedCellsMayHoldSeparatorsAndQuotes) {
  const CsvTable table = tableOf("\"a, b\",\"say \"\"x\"\"\"\n\"1\",2\n");
  EXPECT_EQ(table.names, (std::vector<std::string>{"a, b", "say \"x\""}));
  EXPECT_EQ(table.values(0, 0), 1.0);
}

TEST(Csv, AForeignFormatIsReadWhenSaidAndSuspectedWhenNot) {
  const std::string german = "t;x\n0;1,5\n1;2,5\n";
  EXPECT_NE(errorOf(german).find("is it semicolon?"), std::string::npos) << errorOf(german);
  CsvFormat format{';', ',', {"k.A."}};
  const CsvTable table = readCsv(fileWith(german + "2;k.A.\n"), format);
  EXPECT_EQ(table.values(1, 1), 2.5);
  EXPECT_EQ(table.missing(1), 1);
  EXPECT_EQ(table.at(2, 1), table.file + ":4: column 'x'");
  format.decimal = '.';
  try {
    readCsv(fileWith("x;y\n1;1\n1,5;2\n"), format);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("is it comma?"), std::string::npos) << e.what();
  }
  EXPECT_EQ(separatorOf("tab"), '\t');
  EXPECT_THROW(separatorOf("x"), InputError);
  EXPECT_THROW((CsvFormat{',', ',', {}}.validate()), InputError);
}

TEST(Csv, ImpossibleDatesAndMixedColumnsAreErrors) {
  EXPECT_NE(errorOf("date\n1999-01-01\n1999-02-29\n").find(":3: column 'date'"), std::string::npos);
  EXPECT_NE(errorOf("date\n1999-01-01\n7\n").find("either dates or numbers"), std::string::npos);
}

// Spreadsheets save "Unicode text" as UTF-16; a NUL once cut its cell, "1\\0" + "99" was 1.
TEST(Csv, OtherBytesThanTextAreNamedAndNotShown) {
  const std::string utf16("\xFF\xFEt\0,\0x\0\n\0", 10);
  EXPECT_NE(errorOf(utf16).find(":1: expected text in UTF-8, got UTF-16"), std::string::npos);
  EXPECT_NE(errorOf(std::string("t\0,\0x\0\n\0", 8)).find(":1: expected text in UTF-8, got a NUL"),
            std::string::npos);
  EXPECT_NE(errorOf(std::string("t,x\n0,1\n1,2\0009\n", 14)).find(":3: expected text in UTF-8"),
            std::string::npos);
  const std::string mac = errorOf("t,x\r0,1\r1,2\r");
  EXPECT_NE(mac.find(":1: expected lines that end in LF or CR LF, got CR alone"),
            std::string::npos);
  EXPECT_EQ(mac.find('\r'), std::string::npos);
  EXPECT_NE(errorOf("t,x\n0,1\r1,2\n").find(":2: expected lines"), std::string::npos);
}

TEST(Csv, MalformedTablesNameFileAndLine) {
  EXPECT_NE(errorOf("").find(":1: expected a header line"), std::string::npos);
  EXPECT_NE(errorOf("a,a\n1,2\n").find("only once"), std::string::npos);
  EXPECT_NE(errorOf("a,\n1,2\n").find("a name for every column"), std::string::npos);
  EXPECT_NE(errorOf("a,b\n").find("at least one row"), std::string::npos);
  EXPECT_NE(errorOf("a,b\n1,2\n1,2,3\n").find(":3: expected 2 cells, got 3"), std::string::npos);
  EXPECT_THROW(readCsv(::testing::TempDir() + "no_such_file.csv"), InputError);
  EXPECT_THROW(readCsv(::testing::TempDir()), InputError);
}

void expectRoundTrip(const CsvTable& table) {
  const std::string file = ::testing::TempDir() + "csv_round_trip.csv";
  writeCsv(table, file);
  const CsvTable back = readCsv(file);
  EXPECT_EQ(back.names, table.names);
  EXPECT_EQ(back.units, table.units);
  ASSERT_EQ(back.rows(), table.rows());
  for (Eigen::Index i = 0; i < table.values.size(); ++i) {
    const double a = table.values(i), b = back.values(i);
    EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " became " << b;
  }
}

TEST(Csv, WritingAndReadingGivesTheSameDoubles) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CsvTable table{"", {"t", "x"}, {"h", ""}, Matrix(3, 2)};
  table.values << 0.1, 1.0 / 3.0, nan, 1e-300, 5e22, nan;
  expectRoundTrip(table);
}

TEST(Csv, NamesWithSeparatorsAndQuotesSurvive) {
  CsvTable table{"", {"A,b", "say \"x\"", "c"}, {"", "m,s", "K"}, Matrix::Ones(2, 3)};
  expectRoundTrip(table);
}

TEST(Csv, TheHeaderAloneIsTheSameHeader) {
  const std::string file = fileWith("\xEF\xBB\xBFt[h];x[mg/l]\r\nthis is no row\r\n");
  const CsvTable header = readCsvHeader(file, {';', ',', {}});
  EXPECT_EQ(header.names, (std::vector<std::string>{"t", "x"}));
  EXPECT_EQ(header.units, (std::vector<std::string>{"h", "mg/l"}));
  EXPECT_THROW(readCsvHeader(fileWith("")), InputError);
  EXPECT_THROW(readCsvHeader("no/such/file.csv"), InputError);
}

TEST(Csv, AMissingCellInAnOnlyColumnSurvives) {
  CsvTable table{"", {"x"}, {"mg/l"}, Matrix(3, 1)};
  table.values << 1.0, std::numeric_limits<double>::quiet_NaN(), 3.0;
  expectRoundTrip(table);
}

TEST(Csv, AnUnwritableFileIsAnError) {
  CsvTable table{"", {"x"}, {""}, Matrix::Zero(1, 1)};
  EXPECT_THROW(writeCsv(table, ::testing::TempDir() + "no/such/folder/x.csv"), InputError);
}

}  // namespace base_csv_test
}  // namespace fpc
