// The table of a run: which inputs have switches, and what the windows show.
#include <gtest/gtest.h>

#include <sstream>

#include "runtime/report.hpp"

namespace fpc {
namespace loop_table_test {

/// 1000 samples of one input.
Summary summaryOf(const InputIndices& input) {
  Summary s;
  s.loop = "hand_made";
  s.steps = 1000;
  s.output_names = {"T"};
  s.output_units = {"degC"};
  s.outputs = {OutputIndices{}};
  s.input_names = {"valve"};
  s.inputs = {input};
  return s;
}

/// The cell below "switches".
std::string switchesOf(const InputIndices& input) {
  std::istringstream lines(toTable({summaryOf(input)}));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::string name, value;
    if (cells >> name >> value && name == "hand_made" && value == "valve") {
      for (int i = 0; i < 4; ++i) cells >> value;  // min, max, mean move, switches
      return value;
    }
  }
  return "no such row";
}

InputIndices moved(double min, double max, std::uint64_t moves, double travel) {
  InputIndices u;
  u.min = min;
  u.max = max;
  u.switches = moves;
  u.travel = travel;
  u.mean_abs_move = travel / 1000.0;
  return u;
}

TEST(Table, AnOnOffValveHasSwitches) {
  EXPECT_EQ(switchesOf(moved(0.0, 1.0, 4, 4.0)), "4");
  EXPECT_EQ(switchesOf(moved(2.0, 2.0, 0, 0.0)), "0") << "it never moved";
  EXPECT_EQ(switchesOf(moved(0.0, 3.0, 6, 12.0)), "6") << "three levels";
}

// Figures of mimo_cstr_steps_clp (coolant) and of a valve that stands at its limit for most of a
// run.
TEST(Table, AContinuousValveHasNoneHoweverLongItRests) {
  EXPECT_EQ(switchesOf(moved(50.0, 200.0, 454, 767.4)), "-");
  EXPECT_EQ(switchesOf(moved(0.0, 1600.0, 265, 9000.0)), "-");
  EXPECT_EQ(switchesOf(moved(0.0, 1.0, 830, 830.0)), "-") << "it hardly rests";
}

TEST(Table, WindowsHaveUnitsAndTheirErrorIsExplained) {
  Summary s = summaryOf(moved(0.0, 1.0, 4, 4.0));
  EXPECT_EQ(toTable({s}).find("mean error"), std::string::npos);
  s.windows.push_back({{"hot", "", 1.0, 2.0}, "T", 0.5, -0.25, 10});
  const std::string table = toTable({s});
  EXPECT_NE(table.find("hand_made  T [degC]     hot"), std::string::npos) << table;
  EXPECT_NE(table.find("mean error: of measured - setpoint"), std::string::npos) << table;
}

}  // namespace loop_table_test
}  // namespace fpc
