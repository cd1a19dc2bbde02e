// `fmbpc watch`: its words reach the script, and without a master it says so at once.
#include <gtest/gtest.h>

#include <algorithm>

#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_watch_tool_test {

/// Nobody listens on port 1.
Outcome watchNobody(const std::string& words, bool errors) {
  setenv("ROS_MASTER_URI", "http://localhost:1", 1);
  return tool("watch " + words, errors);
}

class WatchTool : public ::testing::Test {
 protected:
  void SetUp() override {
    if (shell("/usr/bin/python3 -c 'import rospy' 2>/dev/null").code != 0)
      GTEST_SKIP() << "python3-rospy is not installed";
  }
  static void expectLine(const std::string& words, const std::string& part) {
    const Outcome outcome = watchNobody(words, true);
    EXPECT_EQ(outcome.code, 1) << words;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1)
        << words << ": " << outcome.printed;
    EXPECT_EQ(outcome.printed.rfind("fmbpc: ", 0), 0U) << outcome.printed;
    EXPECT_NE(outcome.printed.find(part), std::string::npos) << words << ": " << outcome.printed;
  }
};

TEST_F(WatchTool, WithoutAMasterItSaysSoAtOnce) {
  for (const char* words : {"", "--seconds 0.1", "--seconds=0.1", "--rate 5 --seconds 0.1",
                            "--picture /nowhere/loop.png", "--window"})
    expectLine(words, "no master at http://localhost:1");
}

TEST_F(WatchTool, TheScriptItselfJudgesTheWords) {
  expectLine("--rate 0", "--rate");
  expectLine("--seconds", "--seconds");
  expectLine("run", "unrecognized arguments: run");
  expectLine("--version", "unrecognized arguments: --version");
}

TEST(WatchToolHelp, HelpIsTheScriptsWithAnExample) {
  const Outcome help = watchNobody("--help", false);
  EXPECT_EQ(help.code, 0);
  for (const char* words : {"--picture FILE", "--seconds N", "Example: fmbpc watch"})
    EXPECT_NE(help.printed.find(words), std::string::npos) << help.printed;
  EXPECT_NE(tool("--help").printed.find("watch"), std::string::npos);
}

}  // namespace tool_watch_tool_test
}  // namespace fpc
