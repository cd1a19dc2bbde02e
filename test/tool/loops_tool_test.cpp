// fmbpc loops: title, plant and controller of every loop, also where its data are not there.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/loop_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_loops_tool_test {

using LoopsTool = LoopFolder;

/// As a new user has it: without the public records.
Outcome loopsWithoutRecords(const std::string& words) {
  return shell("env -u FMBPC_DATA " FMBPC_TOOL " loops " + words + " 2>&1");
}

nlohmann::json listed(const Outcome& outcome) {
  EXPECT_EQ(outcome.code, 0) << outcome.printed;
  return nlohmann::json::parse(outcome.printed)["loops"];
}

TEST_F(LoopsTool, ALoopWithoutItsDataStillShowsTitlePlantAndController) {
  const auto loops = listed(loopsWithoutRecords("--json"));
  int needing = 0;
  for (const auto& loop : loops) {
    const std::string name = loop["name"];
    for (const char* key : {"title", "plant", "controller"})
      EXPECT_GT(loop[key].get<std::string>().size(), 1U) << name << " " << key;
    const bool needs = needsRecords(name);
    EXPECT_EQ(loop["needs"],
              needs ? nlohmann::json::array({"FMBPC_DATA"}) : nlohmann::json::array())
        << name;
    needing += needs;
  }
  EXPECT_GE(needing, 30);
}

TEST_F(LoopsTool, TenToBeginWithComeFirstInTheirOrder) {
  const auto loops = listed(loopsWithoutRecords("--json"));
  std::vector<std::string> others;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    EXPECT_EQ(loops[i]["first"], i < 10) << loops[i]["name"];
    if (i >= 10) others.push_back(loops[i]["name"]);
  }
  EXPECT_EQ(loops[0]["name"], "reactor_load");
  EXPECT_EQ(loops[9]["name"], "example_external");
  EXPECT_TRUE(std::is_sorted(others.begin(), others.end()));
  for (std::size_t i = 0; i < 10; ++i) EXPECT_TRUE(loops[i]["needs"].empty()) << loops[i];
  const std::string printed = loopsWithoutRecords("reactor_load").printed;
  EXPECT_LT(printed.find("to begin with:"), printed.find("reactor_load_pi")) << printed;
  EXPECT_LT(printed.find("reactor_load_pi"), printed.find("reactor_load_published")) << printed;
}

TEST_F(LoopsTool, WordsFindThemAndTheTableSaysWhatLacks) {
  const std::string printed = loopsWithoutRecords("bsm1_supervisor").printed;
  std::istringstream lines(printed);
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LT(line.size(), 160U) << line;
    if (line.rfind("bsm1_supervisor ", 0) == 0) found = line;
  }
  for (const char* words : {"bsm1_air", "pi", "dry weather (needs FMBPC_DATA)"})
    EXPECT_NE(found.find(words), std::string::npos) << printed;
}

TEST_F(LoopsTool, WhatTheirTextSaysIsWhatIsReadWithTheData) {
  if (!hasRecords()) GTEST_SKIP() << "FMBPC_DATA is not set";
  const auto with = listed(tool("loops --json"));
  auto without = listed(loopsWithoutRecords("--json"));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_TRUE(with[i]["needs"].empty()) << with[i];
    without[i]["needs"] = nlohmann::json::array();
    EXPECT_EQ(with[i], without[i]);
  }
}

TEST_F(LoopsTool, ALoopThatIsWrongIsListedWithWhatItsTextSays) {
  std::filesystem::create_directory(folder_ / "loop");
  write("loop/mine_wrong.yaml",
        "extends: asp_case1_clp\ntitle: Mine\nclp: false\nsampling: {nonsense: 1}\n");
  setenv("FMBPC_CONFIG_PATH", folder_.c_str(), 1);
  const auto loops = listed(tool("loops --json mine_wrong"));
  unsetenv("FMBPC_CONFIG_PATH");
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0]["plant"], "activated_sludge");
  EXPECT_EQ(loops[0]["controller"], "fmbpc");
  expectWords(loops[0]["title"], {"Mine (cannot be read: ", "mine_wrong.yaml:4", "nonsense"});
}

// Nodes of a YAML tree take hundreds of bytes each: they are counted before there is one.
#if defined(__SANITIZE_ADDRESS__)
const std::string kLittleMemory;  // the sanitizer maps terabytes
#else
const std::string kLittleMemory = "ulimit -v 400000; ";
#endif

TEST_F(LoopsTool, ALoopFileOfTooManyValuesIsRefusedBeforeItTakesMemory) {
  std::string values = "title: many\nsetpoint: {schedule: [1";
  for (int i = 0; i < 1'500'000; ++i) values += ",1";
  const Outcome outcome = shell(kLittleMemory + FMBPC_TOOL " resolve " +
                                write("many.yaml", values + "]}\n") + " 2>&1 >/dev/null");
  EXPECT_EQ(outcome.code, 1);
  expectWords(outcome.printed.substr(0, outcome.printed.size() - 1),
              {"many.yaml:2", "at most 1000000 values"});
}

}  // namespace tool_loops_tool_test
}  // namespace fpc
