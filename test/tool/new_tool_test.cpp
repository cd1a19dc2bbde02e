// fmbpc new: what is written runs, and says what is wrong. Packages are built in
// example_package_test.py.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_new_tool_test {

using NewTool = LoopFolder;
using Json = nlohmann::json;

Outcome newLoop(const std::string& folder, const std::string& arguments) {
  return tool("new loop mine --out " + folder + " " + arguments);
}

/// On its model: whole, inside its limits.
void runOn(const std::string& file) {
  const LoopFile loop = readLoop(file, {{"plant.type", "model"}});
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  EXPECT_TRUE(summary.complete) << file;
  EXPECT_EQ(summary.input_violations + summary.move_violations, 0U) << file;
}

TEST_F(NewTool, ALoopOfAModelRunsAndIsStable) {
  for (const char* model : {"cstr_auto", "asp_auto_d"}) {
    const std::string folder = path(model);
    ASSERT_EQ(newLoop(folder, std::string("--model ") + model).code, 0) << model;
    for (const char* loop : {"/mine.yaml", "/mine_pi.yaml"}) runOn(folder + loop);
    for (const char* loop : {"/mine.yaml", "/mine_pi.yaml"}) {
      const Outcome asked = tool("stability --json --points 2 " + folder + loop);
      ASSERT_EQ(asked.code, 0) << model;
      for (const Json& point : Json::parse(asked.printed)["points"])
        EXPECT_EQ(point["stable"], true) << model << loop << ": " << point["verdict"];
    }
  }
}

TEST_F(NewTool, TheLawIsCheaperThanThePiUnderNoiseThatNothingWasChosenBy) {
  ASSERT_EQ(newLoop(path("new"), "--model cstr_auto").code, 0);
  const auto meanIse = [&](const std::string& file) {
    double sum = 0.0;
    for (const char* seed : {"21", "22", "23", "24", "25"}) {
      const LoopFile loop = readLoop(path("new") + file, {{"seed", seed}});
      sum += summarize(loop, runLoop(loop), 0.0).outputs.front().ise;
    }
    return sum / 5.0;
  };
  EXPECT_LT(meanIse("/mine.yaml"), 0.9 * meanIse("/mine_pi.yaml"));
}

TEST_F(NewTool, ALoopForARealPlantIsReadAndRehearsed) {
  for (const char* plant : {"external", "float64", "modbus"}) {
    const std::string folder = path(plant);
    ASSERT_EQ(newLoop(folder, std::string("--model cstr_auto --plant ") + plant).code, 0);
    const LoopFile loop = readLoop(folder + "/mine.yaml");
    EXPECT_TRUE(loop.external_plant);
    EXPECT_EQ(loop.gateway.enabled(), std::string(plant) != "external");
    EXPECT_EQ(tool("run --on-model --no-plot " + folder + "/mine.yaml").code, 0) << plant;
    EXPECT_NE(tool("run " + folder + "/mine.yaml", true).code, 0) << "its plant is not here";
  }
}

TEST_F(NewTool, NothingIsOverwrittenAndMistakesAreNamed) {
  ASSERT_EQ(newLoop(path("a"), "--model cstr_auto").code, 0);
  const Outcome again = tool("new loop mine --model cstr_auto --out " + path("a"), true);
  EXPECT_EQ(again.code, 1);
  EXPECT_NE(again.printed.find("mine.yaml"), std::string::npos) << again.printed;
  EXPECT_EQ(tool("new loop mine --model nowhere --out " + path("b"), true).code, 1);
  EXPECT_EQ(tool("new plant 'My Tank' --out " + path("b"), true).code, 1);
  ASSERT_EQ(tool("new plant my_tank --out " + path("b")).code, 0);
  EXPECT_EQ(tool("new plant my_tank --out " + path("b"), true).code, 1);
}

TEST_F(NewTool, APackageHasItsNameEverywhere) {
  for (const char* kind : {"plant", "controller"}) {
    const std::string name = std::string("my_") + kind;
    ASSERT_EQ(tool(std::string("new ") + kind + " " + name + " --out " + folder_.string()).code, 0);
    for (const std::string& file : {std::string("CMakeLists.txt"), std::string("package.xml"),
                                    "src/" + name + ".cpp", "config/loop/" + name + "_case.yaml"}) {
      std::ifstream stream(path(name) + "/" + file);
      const std::string text{std::istreambuf_iterator<char>(stream), {}};
      EXPECT_NE(text.find(name), std::string::npos) << file;
      EXPECT_EQ(text.find('@'), text.find("@example")) << file << " has a blank left";
    }
  }
}

}  // namespace tool_new_tool_test
}  // namespace fpc
