// fmbpc identify with data that cannot be identified from: one line naming file and column, and no
// model.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "tool/identify_fixture.hpp"

namespace fpc {
namespace tool_identify_errors_test {

class IdentifyErrors : public IdentifyTool {
 protected:
  void expectError(const std::string& data, std::initializer_list<std::string> words,
                   const std::string& rest = "") {
    const std::string command =
        "identify " + data + " " + structure_ + " " + rest + " --out " + path("model.yaml");
    const Outcome outcome = tool(command, true);
    EXPECT_EQ(outcome.code, 1) << outcome.printed;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1);
    for (const auto& word : words)
      EXPECT_NE(outcome.printed.find(word), std::string::npos) << word << ": " << outcome.printed;
    EXPECT_EQ(tool(command).printed, "");
    EXPECT_FALSE(std::filesystem::exists(path("model.yaml")));
  }
  std::string spoilt(const std::function<void(CsvTable&)>& spoil) {
    CsvTable table = record();
    spoil(table);
    return writeRecord("spoilt.csv", table);
  }
};

TEST_F(IdentifyErrors, MissingCellsAreCounted) {
  expectError(spoilt([](CsvTable& t) { t.values(40, 2) = kNaN; }),
              {"spoilt.csv", "'u'", "1 are", ":42:"});
}

TEST_F(IdentifyErrors, TheInputOfTheLastRowActsOnNothingAndMayBeMissing) {
  const std::string file = spoilt([](CsvTable& t) { t.values(299, 2) = kNaN; });
  const auto json = parsed(tool("identify " + file + " " + structure_ + " --json").printed);
  const auto whole = parsed(tool(onRecord("--json")).printed);
  EXPECT_EQ(json["identification"], whole["identification"]);
  expectError(spoilt([](CsvTable& t) { t.values(299, 1) = kNaN; }), {"spoilt.csv", "'y'"});
}

TEST_F(IdentifyErrors, ColumnsThatNeverMove) {
  expectError(spoilt([](CsvTable& t) { t.values.col(2).setConstant(3.0); }),
              {"spoilt.csv", "'u'", "move"});
}

TEST_F(IdentifyErrors, ColumnsThatRepeatAnother) {
  expectError(spoilt([](CsvTable& t) { t.values.col(2) = t.values.col(1); }),
              {"spoilt.csv", "'u'", "'y'"});
}

TEST_F(IdentifyErrors, TooFewRows) {
  expectError(data_, {"data.csv", "'y'", "at least"}, "--rows 1:12");
  expectError(data_, {"data.csv", "at least 10 rows"}, "--rows 1:5");
  expectError(data_, {"data.csv", "rows within 1:300"}, "--rows 1:301");
}

TEST_F(IdentifyErrors, TimesThatAreNotSorted) {
  expectError(spoilt([](CsvTable& t) { std::swap(t.values(10, 0), t.values(11, 0)); }),
              {"spoilt.csv", "'time'", "increase", ":13:"});
}

TEST_F(IdentifyErrors, UnitsThatAreNotThoseOfTheStructure) {
  expectError(spoilt([](CsvTable& t) { t.units[1] = "g/l"; }), {"spoilt.csv", "'y'", "[g/l]"});
  expectError(spoilt([](CsvTable& t) { t.values.col(1) *= 1000.0; }),
              {"spoilt.csv", "'y'", "another unit?"});
  expectError(spoilt([](CsvTable& t) { t.units[0] = "h"; }), {"spoilt.csv", "'time'", "[h]"});
}

TEST_F(IdentifyErrors, ColumnsThatAreNotThere) {
  expectError(spoilt([](CsvTable& t) { t.names[2] = "v"; }), {"spoilt.csv", "'u'", "time, y, v"});
}

TEST_F(IdentifyErrors, FilesThatCannotBeReadOrWritten) {
  expectError(path("none.csv"), {"none.csv"});
  expectError(data_, {"none.csv"}, "--rows :200 --validate " + path("none.csv"));
  expectError(write("fake.bag", "no bag at all"), {"fake.bag"});
  for (const std::string& target : {path("no_folder/model.yaml"), folder_.string()}) {
    const Outcome outcome = tool(onRecord("--out " + target), true);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.printed.find(target), std::string::npos) << outcome.printed;
  }
}

#ifdef FMBPC_WITHOUT_ROS
TEST_F(IdentifyErrors, ABagSaysThatThisProgramReadsNone) {
  expectError(write("loop.bag", "#ROSBAG V2.0"), {"loop.bag", "expected a CSV", "without ROS"});
  expectError(write("renamed.csv", "#ROSBAG V2.0"), {"renamed.csv", "without ROS"});
}
#endif

TEST_F(IdentifyErrors, UnknownStructuresAreAnsweredWithTheNearest) {
  const Outcome outcome = tool("identify " + data_ + " asp_cc", true);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.printed.find("asp_c"), std::string::npos) << outcome.printed;
}

}  // namespace tool_identify_errors_test
}  // namespace fpc
