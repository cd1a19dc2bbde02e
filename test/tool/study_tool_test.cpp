// fmbpc study as a person or a script calls it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "study/tuning_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_study_tool_test {

class StudyTool : public LoopFolder {
 protected:
  StudyTool() {
    write("lag.yaml", lagLoop());
    write("good.yaml",
          "extends: lag.yaml\ncontroller:\n  loops:\n"
          "    - {input: u, output: y, kp: 1, ki_per_h: 6}\n");
  }
  std::string loops() const { return path("good.yaml") + " " + path("lag.yaml"); }
  nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = tool("study " + arguments + " --json");
    EXPECT_EQ(outcome.code, 0) << arguments;
    return nlohmann::json::parse(outcome.printed);
  }
};

TEST_F(StudyTool, ComparesLoopsInPairsFromOptions) {
  const auto study = json(loops() + " --seeds 1:6 --noise y=0.01" +
                          " --vary plant.matrix.elements.0.gain=0.8:1.2");
  EXPECT_EQ(study["complete"], true);
  EXPECT_EQ(study["cases"], 6);
  ASSERT_EQ(study["loops"].size(), 2U);
  ASSERT_EQ(study["pairs"].size(), 1U);
  EXPECT_EQ(study["pairs"][0]["wins"], 6.0);
  EXPECT_EQ(study["runs"].size(), 12U);
  const std::string table = tool("study " + loops() + " --seeds 1:6").printed;
  for (const char* word : {"median", "quartiles", "worst", "locked", "out of model", "won"})
    EXPECT_NE(table.find(word), std::string::npos) << word << " is not in\n" << table;
}

TEST_F(StudyTool, TooFewCasesHaveNoIntervalOfTheMedian) {
  const auto study = json(loops() + " --seeds 1:5");
  EXPECT_TRUE(study["pairs"][0]["ratio_interval"][0].is_null());
  EXPECT_TRUE(study["pairs"][0]["share_interval"][0].is_number());
  EXPECT_NE(tool("study " + loops() + " --seeds 1:5").printed.find("none (n < 6)"),
            std::string::npos);
  EXPECT_TRUE(json(loops() + " --seeds 1:6")["pairs"][0]["ratio_interval"][1].is_number());
}

TEST_F(StudyTool, WritesItsFilesAndResumesToTheSameNumbers) {
  const std::string options = loops() + " --seeds 1:5 --no-plot --out ";
  const auto whole = json(options + path("whole"));
  for (const char* file : {"study.json", "runs.csv", "state.json"})
    EXPECT_TRUE(std::filesystem::exists(path("whole") + "/" + file)) << file;
  std::filesystem::create_directories(path("part"));
  auto state = nlohmann::json::parse(std::ifstream(path("whole") + "/state.json"));
  for (const char* run : {"1", "4", "7"}) state["runs"].erase(run);
  std::ofstream(path("part") + "/state.json") << state;
  const auto rest = json(options + path("part") + " --resume");
  EXPECT_EQ(rest["resumed"], 7);
  EXPECT_EQ(rest["loops"], whole["loops"]);
  EXPECT_EQ(rest["pairs"], whole["pairs"]);
  EXPECT_EQ(rest["runs"], whole["runs"]);
  const Outcome other =
      tool("study " + loops() + " --seeds 2:6 --resume --out " + path("part"), true);
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.printed.find("state of this study"), std::string::npos) << other.printed;
}

TEST_F(StudyTool, FailsWithAReasonIfALoopHasNoRunToJudge) {
  const std::string frozen =
      "cstr_tracking_pi --seeds 1:2 --noise CA=0.001 --set plant.integrator.max_steps=2";
  const Outcome errors = tool("study " + frozen, true);
  EXPECT_EQ(errors.code, 1);
  for (const char* words : {"none of 2 runs succeeded", "seed 1: sample 0", "integration"})
    EXPECT_NE(errors.printed.find(words), std::string::npos) << words << " in " << errors.printed;
  const std::string table = tool("study " + frozen).printed;
  EXPECT_NE(table.find("sample 0"), std::string::npos) << table;
  const Outcome typo = tool("study " + loops() + " --seeds 1:3 --noise Y=0.1", true);
  EXPECT_EQ(typo.code, 1);
  EXPECT_NE(typo.printed.find("noise.Y: expected one of y"), std::string::npos) << typo.printed;
}

TEST_F(StudyTool, TakesAStudyFile) {
  write("s.yaml", "title: Two gains\nloops:\n  - {loop: " + path("good.yaml") +
                      "}\n  - {loop: " + path("lag.yaml") +
                      ", name: slow}\nseeds: 1:3\nfitness: {terms: [{index: ise, output: y}]}\n");
  const auto study = json(path("s.yaml"));
  EXPECT_EQ(study["title"], "Two gains");
  EXPECT_EQ(study["pairs"][0]["against"], "slow");
}

TEST_F(StudyTool, AMisspeltNameIsTakenForAStudyOrALoop) {
  for (const auto& [typo, meant] :
       {std::pair<const char*, const char*>{"sludge_gaurd", "near: sludge_guard"},
        {"column_limit", "near: column_limits"},
        {"asp_case11", "near: asp_case1"}}) {
    const Outcome outcome = tool(std::string("study ") + typo, true);
    EXPECT_EQ(outcome.code, 1) << typo;
    EXPECT_NE(outcome.printed.find(std::string("study or loop '") + typo), std::string::npos)
        << outcome.printed;
    EXPECT_NE(outcome.printed.find(meant), std::string::npos) << outcome.printed;
  }
  const std::string none = tool("study " + path("none.yaml"), true).printed;
  EXPECT_NE(none.find("none.yaml: expected an existing file of a study or a loop"),
            std::string::npos)
      << none;
}

TEST_F(StudyTool, MistakesAreOneLine) {
  for (const std::string& wrong :
       {loops() + " --seeds 3:1", loops() + " --vary k", loops() + " --seeds 1 --noise y",
        loops() + " --seeds 1:3 --noise y=0", loops() + " --resume",
        path("lag.yaml") + " --against nobody"}) {
    const Outcome outcome = tool("study " + wrong, true);
    EXPECT_EQ(outcome.code, 1) << wrong;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1)
        << outcome.printed;
  }
}

}  // namespace tool_study_tool_test
}  // namespace fpc
