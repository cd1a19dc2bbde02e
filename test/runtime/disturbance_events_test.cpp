// What the record of the disturbances adds to a summary, from one reading of it.
#include <cstdio>
#include <filesystem>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_disturbance_events_test {

class DisturbanceEvents : public LoopFolder {
 protected:
  /// An hour of the heated tank; T_in comes every 30 s from a file with times in days.
  Summary summaryWith(int digits, const std::string& commands = "[]") {
    std::string text = "t,v\n";
    for (int k = 0; k <= 130; ++k) {
      char row[64];
      std::snprintf(row, sizeof row, "%.*f,%s\n", digits, k * 30.0 / 86400.0, k == 5 ? "" : "15");
      text += row;
    }
    write("record.csv", text);
    const LoopFile loop =
        readLoop(write("loop.yaml",
                       "extends: heated_tank\nsampling: {duration_h: 1}\ndisturbance:\n"
                       "  source: csv\n  commands: " +
                           commands +
                           "\n  csv: {file: record.csv, time_column: t, time_unit: d, missing: "
                           "hold, channels: {T_in: {column: v}}}\n"));
    return summarize(loop, runLoop(loop), 0.0);
  }
  static bool says(const Summary& summary, EventCode code) {
    return contains(summary.events, code);
  }
};

TEST_F(DisturbanceEvents, RoundedTimesAreSaidAndExactOnesAreNot) {
  const Summary rounded = summaryWith(5);
  EXPECT_TRUE(says(rounded, EventCode::kTimesRounded));
  EXPECT_FALSE(says(summaryWith(10), EventCode::kTimesRounded));
  EXPECT_TRUE(says(rounded, EventCode::kCellsFilled));
}

TEST_F(DisturbanceEvents, ARecordOfWhichOnlyOneRowActsIsSaid) {
  write("long.csv", "t,v\n0,15\n1,16\n2,17\n");
  const auto said = [&](const std::string& unit) {
    const LoopFile loop =
        readLoop(write("l.yaml",
                       "extends: heated_tank\nsampling: {duration_h: 1.5}\ndisturbance:\n"
                       "  source: csv\n  commands: []\n  csv: {file: long.csv, time_column: t, "
                       "time_unit: " +
                           unit + ", channels: {T_in: {column: v}}}\n"));
    return says(summarize(loop, runLoop(loop), 0.0), EventCode::kRecordUnused);
  };
  EXPECT_FALSE(said("h"));
  EXPECT_TRUE(said("d"));
}

TEST_F(DisturbanceEvents, ARecordThatIsLedInForTheWholeRunIsNotCalledOneRow) {
  write("long.csv", "t,v\n0,15\n1,16\n2,17\n");
  const LoopFile loop = readLoop(
      write("l.yaml",
            "extends: heated_tank\nsampling: {duration_h: 1.5}\ndisturbance:\n  source: csv\n"
            "  commands: []\n  csv: {file: long.csv, time_column: t, time_unit: h, lead_in_h: 1.5, "
            "channels: {T_in: {column: v}}}\n"));
  EXPECT_FALSE(says(summarize(loop, runLoop(loop), 0.0), EventCode::kRecordUnused));
}

TEST_F(DisturbanceEvents, ARecordThatGoesDuringTheRunCostsNoRun) {
  write("long.csv", "t,v\n0,15\n1,16\n2,17\n");
  const LoopFile loop = readLoop(write(
      "l.yaml",
      "extends: heated_tank\nsampling: {duration_h: 1.5}\ndisturbance:\n  source: csv\n"
      "  commands: [{time_h: 1, name: T_in, value: 2, mode: offset}]\n"
      "  csv: {file: long.csv, time_column: t, time_unit: h, channels: {T_in: {column: v}}}\n"));
  RunOptions options;
  options.progress = [&](std::uint32_t step, std::uint32_t) {
    if (step == 20) std::filesystem::remove(path("long.csv"));
  };
  EXPECT_TRUE(runLoop(loop, options).complete);
}

TEST_F(DisturbanceEvents, AWindowBeyondTheRunIsSaid) {
  const auto said = [](const char* from) {
    const LoopFile loop = readLoop(
        "heated_tank",
        {{"report.windows", "[{name: late, between_s: [" + std::string(from) + ", 43200]}]"}});
    return says(summarize(loop, runLoop(loop), 0.0), EventCode::kBeyondRun);
  };
  EXPECT_TRUE(said("36000"));
  EXPECT_FALSE(said("7200"));
}

TEST_F(DisturbanceEvents, OffsetsAreCutAgainstTheRecord) {
  const EventCode cut = EventCode::kDisturbanceClamped;
  EXPECT_TRUE(says(summaryWith(10, "[{time_h: 0.5, name: T_in, value: -20, mode: offset}]"), cut));
  EXPECT_FALSE(says(summaryWith(10, "[{time_h: 0.5, name: T_in, value: -9, mode: offset}]"), cut));
}

}  // namespace loop_disturbance_events_test
}  // namespace fpc
