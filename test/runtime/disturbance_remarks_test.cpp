// What the record of the disturbances adds to a summary, from one reading of it.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_disturbance_remarks_test {

class DisturbanceRemarks : public LoopFolder {
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
  static bool says(const Summary& summary, const std::string& words) {
    return std::any_of(summary.remarks.begin(), summary.remarks.end(), [&](const RunRemark& r) {
      return r.words.find(words) != std::string::npos;
    });
  }
};

TEST_F(DisturbanceRemarks, RoundedTimesAreSaidAndExactOnesAreNot) {
  const Summary rounded = summaryWith(5);
  EXPECT_TRUE(says(rounded, "of 119 rows of the disturbance record come at most 2 % of a sample"));
  EXPECT_FALSE(says(summaryWith(10), "rows of the disturbance record"));
  EXPECT_EQ(rounded.repaired_cells, 1U);
}

TEST_F(DisturbanceRemarks, ARecordOfWhichOnlyOneRowActsIsSaid) {
  write("long.csv", "t,v\n0,15\n1,16\n2,17\n");
  const auto remark = [&](const std::string& unit) {
    const LoopFile loop =
        readLoop(write("l.yaml",
                       "extends: heated_tank\nsampling: {duration_h: 1.5}\ndisturbance:\n"
                       "  source: csv\n  commands: []\n  csv: {file: long.csv, time_column: t, "
                       "time_unit: " +
                           unit + ", channels: {T_in: {column: v}}}\n"));
    return says(summarize(loop, runLoop(loop), 0.0), "only the first row");
  };
  EXPECT_FALSE(remark("h"));
  EXPECT_TRUE(remark("d"));
}

TEST_F(DisturbanceRemarks, ARecordThatIsLedInForTheWholeRunIsNotCalledOneRow) {
  write("long.csv", "t,v\n0,15\n1,16\n2,17\n");
  const LoopFile loop = readLoop(
      write("l.yaml",
            "extends: heated_tank\nsampling: {duration_h: 1.5}\ndisturbance:\n  source: csv\n"
            "  commands: []\n  csv: {file: long.csv, time_column: t, time_unit: h, lead_in_h: 1.5, "
            "channels: {T_in: {column: v}}}\n"));
  EXPECT_FALSE(says(summarize(loop, runLoop(loop), 0.0), "only the first row"));
}

TEST_F(DisturbanceRemarks, ARecordThatGoesDuringTheRunCostsNoRun) {
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

TEST_F(DisturbanceRemarks, AWindowBeyondTheRunIsSaid) {
  const auto remark = [](const char* from) {
    const LoopFile loop = readLoop(
        "heated_tank",
        {{"report.windows", "[{name: late, from_h: " + std::string(from) + ", to_h: 12}]"}});
    return says(summarize(loop, runLoop(loop), 0.0), "window late of report.windows begins only");
  };
  EXPECT_TRUE(remark("10"));
  EXPECT_FALSE(remark("2"));
}

TEST_F(DisturbanceRemarks, OffsetsAreCutAgainstTheRecord) {
  const std::string cut = "an offset of T_in was asked beyond its range, 0..40";
  EXPECT_TRUE(says(summaryWith(10, "[{time_h: 0.5, name: T_in, value: -20, mode: offset}]"), cut));
  EXPECT_FALSE(says(summaryWith(10, "[{time_h: 0.5, name: T_in, value: -9, mode: offset}]"), cut));
}

}  // namespace loop_disturbance_remarks_test
}  // namespace fpc
