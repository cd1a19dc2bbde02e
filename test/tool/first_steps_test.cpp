// What an outsider does first: a comparison with its verdict, a record that is missing, one that
// ships.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "config/plugins.hpp"
#include "paths.hpp"
#include "runtime/loop_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_first_steps_test {

using FirstSteps = LoopFolder;
const std::string kShort = " --set sampling.duration_h=40";

TEST_F(FirstSteps, AComparisonEndsWithAVerdictAndIsOnePicture) {
  const bool draws = std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  const std::string out = " --out " + folder_.string() + (draws ? "" : " --no-plot");
  const Outcome outcome = tool("run asp_case1_pi_x_tuned asp_case1_pi_x" + out + kShort);
  EXPECT_EQ(outcome.code, 0);
  const std::string last = outcome.printed.substr(outcome.printed.rfind("\n\n") + 2);
  EXPECT_EQ(last.rfind("Verdict: PI on biomass, tuned (asp_case1_pi_x_tuned) wins: ISE of x ", 0),
            0U)
      << last;
  EXPECT_EQ(std::filesystem::exists(path("comparison.png")), draws);
  EXPECT_FALSE(std::filesystem::exists(path("asp_case1_pi_x/plot.png")));
  const Outcome table =
      tool("table --short " + path("asp_case1_pi_x_tuned") + " " + path("asp_case1_pi_x"));
  EXPECT_EQ(table.printed.substr(table.printed.rfind("\n\n") + 2), last);
  EXPECT_EQ(tool("run asp_case1_pi_x" + out + kShort).printed.find("Verdict"), std::string::npos);
}

TEST_F(FirstSteps, TheDemonstrationShowsALawThatWins) {
  const std::string printed =
      tool("run reactor_load reactor_load_pi reactor_load_published").printed;
  EXPECT_NE(printed.find("Verdict: FMBPC that estimates both (reactor_load) wins: ISE of CA "),
            std::string::npos)
      << printed;
}

/// As after scripts/demo: the tool and the core, each alone in a folder.
TEST_F(FirstSteps, WhatIsNotBuiltYetIsSaidInOneLine) {
  namespace fs = std::filesystem;
  fs::copy(FMBPC_TOOL, folder_);
  fs::copy(fs::canonical(libraryFolder() + "/libfmbpc_core.so"), folder_ / "core.so");
  fs::rename(folder_ / "core.so", folder_ / FMBPC_CORE_SONAME);
  const std::string alone =
      "LD_LIBRARY_PATH=" + folder_.string() + ":$LD_LIBRARY_PATH " + path("fmbpc_tool") + " ";
  for (const char* command : {"identify --help", "tune", "run asp_identify --no-plot"}) {
    const Outcome outcome = shell(alone + command + " 2>&1 >/dev/null");
    EXPECT_EQ(outcome.code, 1) << command;
    EXPECT_NE(outcome.printed.find("`scripts/build` makes it"), std::string::npos)
        << command << ": " << outcome.printed;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1)
        << command << ": " << outcome.printed;
  }
  EXPECT_EQ(shell(alone + "resolve asp_case1_clp 2>&1 >/dev/null").printed, "");
}

TEST_F(FirstSteps, ARecordThatDoesNotShipIsNamedWithItsSource) {
  for (const char* command : {"env -u FMBPC_DATA " FMBPC_TOOL " run asp_bsm1_dry 2>&1",
                              "env FMBPC_DATA=/nowhere " FMBPC_TOOL " run asp_bsm1_dry 2>&1",
                              FMBPC_TOOL " validate fm_1 /bsm1_influent_dry.csv 2>&1"}) {
    const Outcome outcome = shell(command);
    EXPECT_EQ(outcome.code, 1) << command;
    for (const char* part :
         {"bsm1_influent_dry.csv is a public record", "IWA task group", "FMBPC_DATA",
          "c8776bdfacd9d68506d7f7e9db0741835ba29b639785b0e0849a3bf1401e969b"})
      EXPECT_NE(outcome.printed.find(part), std::string::npos)
          << command << ": " << outcome.printed;
  }
}

TEST_F(FirstSteps, TheShippedRecordIsIdentified) {
  const Outcome outcome = tool("identify " + sourceDir() +
                               "/examples/reactor_record.csv --auto --kind linear --inputs q_c "
                               "--outputs CA --budget 2 --json");
  EXPECT_EQ(outcome.code, 0) << outcome.printed;
}

}  // namespace tool_first_steps_test
}  // namespace fpc
