// fmbpc tune as a person or a script calls it.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "optim/population_search.hpp"
#include "study/tuning_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_tune_tool_test {

class TuneTool : public LoopFolder {
 protected:
  TuneTool() {
    write("lag.yaml", lagLoop());
    write("t.yaml", lagTuning());
  }
  std::string files() const { return path("lag.yaml") + " " + path("t.yaml"); }
  nlohmann::json json(const std::string& arguments, int code = 0) const {
    const Outcome outcome = tool("tune " + files() + " --json --no-plot " + arguments);
    EXPECT_EQ(outcome.code, code) << arguments;
    return nlohmann::json::parse(outcome.printed);
  }
};

TEST_F(TuneTool, WritesALoopThatIsBetterOnHeldOutScenarios) {
  const auto tuned = json("--out " + path("out"));
  EXPECT_EQ(tuned["evaluations"], 60);
  EXPECT_EQ(tuned["worse"], false);
  EXPECT_LT(tuned["held_out"]["after"]["cost"].get<double>(),
            0.5 * tuned["held_out"]["before"]["cost"].get<double>());
  for (const char* file : {"history.csv", "tuning.json", "state.json", "lag_tuned.yaml"})
    EXPECT_TRUE(std::filesystem::exists(path("out") + "/" + file)) << file;
  const Outcome run = tool("run --json " + path("out") + "/lag_tuned.yaml");
  ASSERT_EQ(run.code, 0);
  const auto judged = nlohmann::json::parse(run.printed);
  const auto before = nlohmann::json::parse(tool("run --json " + path("lag.yaml")).printed);
  EXPECT_LT(judged["outputs"]["y"]["ise"].get<double>(),
            before["outputs"]["y"]["ise"].get<double>());
}

TEST_F(TuneTool, PrintsTheSameAnswerForAnyNumberOfThreads) {
  auto one = json("--threads 1"), four = json("--threads 4");
  for (const char* key : {"threads", "seconds", "evaluations_per_s"}) {
    one.erase(key);
    four.erase(key);
  }
  EXPECT_EQ(one, four);
}

TEST_F(TuneTool, ResumesToTheSameTuning) {
  const auto whole = json("--out " + path("whole"));
  json("--out " + path("part") + " --method random --evaluations 24");
  const Outcome other = tool("tune " + files() + " --resume --out " + path("part"), true);
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.printed.find("state of this tuning"), std::string::npos) << other.printed;
  EXPECT_NE(other.printed.find("the files that the loop names"), std::string::npos);
  // The state as a stop after three generations leaves it.
  std::ifstream stream(path("whole") + "/state.json");
  auto state = nlohmann::json::parse(stream);
  auto& steps = state["evaluations"];
  steps.erase(steps.begin() + 24, steps.end());
  std::ofstream(path("part") + "/state.json") << state;
  const auto rest = json("--resume --out " + path("part"));
  EXPECT_EQ(rest["resumed"], 24);
  EXPECT_EQ(rest["after"], whole["after"]);
  EXPECT_EQ(rest["parameters"], whole["parameters"]);
  const auto read = [](const std::string& file) {
    std::ifstream text(file);
    return std::string((std::istreambuf_iterator<char>(text)), {});
  };
  EXPECT_EQ(read(path("part") + "/history.csv"), read(path("whole") + "/history.csv"));
}

TEST_F(TuneTool, SaysWhichParametersStandAtABound) {
  write("t.yaml",
        "parameters:\n  - {key: controller.loops.0.kp, lower: 0.1, upper: 0.3}\n"
        "fitness: {terms: [{index: ise, output: y}]}\n"
        "scenarios: {seeds: [1]}\n"
        "held_out: [{name: fast, set: {controller.loops.0.ki_per_h: 60}}]\n"
        "search: {population: 8, evaluations: 40}\n");
  const auto tuned = json("--out " + path("out"));
  ASSERT_EQ(tuned["parameters"][0]["at_bound"], "upper");
  const std::string told = tool("tune " + files() + " --no-plot").printed;
  EXPECT_NE(told.find("controller.loops.0.kp ends at the upper bound of its range, 0.3"),
            std::string::npos)
      << told;
  EXPECT_EQ(told.find("got worse"), std::string::npos) << told;
  std::ifstream written(path("out") + "/lag_tuned.yaml");
  const std::string text((std::istreambuf_iterator<char>(written)), {});
  EXPECT_NE(text.find("# controller.loops.0.kp ends at the upper bound"), std::string::npos)
      << text;
}

/// The loop's gains, 0.2 and 0.5, lie outside both ranges, in which everything is worse.
TEST_F(TuneTool, SaysWhatTheLoopHadAndThatItWasBetter) {
  write("t.yaml",
        "parameters:\n  - {key: controller.loops.0.kp, lower: 0.001, upper: 0.002}\n"
        "  - {key: controller.loops.0.ki_per_h, lower: 0.001, upper: 0.002}\n"
        "fitness: {terms: [{index: ise, output: y}]}\n"
        "search: {population: 4, evaluations: 8}\n");
  const auto tuned = json("", 3);
  EXPECT_EQ(tuned["worse"], true);
  EXPECT_EQ(tuned["parameters"][0]["before"], 0.2);
  EXPECT_EQ(tuned["parameters"][1]["before"], 0.5);
  EXPECT_GT(tuned["after"]["cost"], tuned["before"]["cost"]);
  const std::string told = tool("tune " + files() + " --no-plot").printed;
  for (const char* words : {"0.2 (outside)", "0.5 (outside)", "kp of the untouched loop, 0.2, lies",
                            "worse than that of the untouched loop"})
    EXPECT_NE(told.find(words), std::string::npos) << words << " in " << told;
  EXPECT_EQ(told.rfind("the tuned cost is worse", 0), 0U) << told;
}

/// The best gain of the plant, 2.9, is unstable where the plant's is ten times as large.
TEST_F(TuneTool, SaysFirstThatHeldOutCostGotWorseAndEndsWithACodeOfItsOwn) {
  write("t.yaml",
        "parameters:\n  - {key: controller.loops.0.kp, lower: 0.1, upper: 5}\n"
        "fitness: {terms: [{index: ise, output: y}]}\n"
        "held_out: [{name: steep, set: {plant.matrix.elements.0.gain: 20}}]\n"
        "search: {population: 8, evaluations: 24}\n");
  const auto tuned = json("--out " + path("out"), 3);
  EXPECT_LT(tuned["after"]["cost"], tuned["before"]["cost"]);
  EXPECT_GT(tuned["held_out"]["after"]["cost"], tuned["held_out"]["before"]["cost"]);
  EXPECT_EQ(tuned["worse"], true);
  const std::string words = "the cost on held-out scenarios got worse, ";
  EXPECT_NE(tuned["remarks"].dump().find(words), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(path("out") + "/lag_tuned.yaml"));
  const Outcome table = tool("tune " + files() + " --no-plot");
  EXPECT_EQ(table.code, 3);
  EXPECT_EQ(table.printed.rfind(words, 0), 0U) << table.printed;
  EXPECT_EQ(table.printed.find(words, 1), std::string::npos) << "once: " << table.printed;
  const std::string errors = tool("tune " + files() + " --no-plot", true).printed;
  EXPECT_NE(errors.find("lag.yaml: " + words), std::string::npos) << errors;
}

/// A cap below every cost, and a plant that no gain moves: the search saw nothing.
TEST_F(TuneTool, SaysThatNothingWasFoundWhereEveryPointCostsTheSame) {
  const std::string parameter =
      "parameters:\n  - {key: controller.loops.0.kp, lower: 0.2, upper: 5}\n"
      "search: {population: 4, evaluations: 12}\n";
  const std::string term = "fitness: {terms: [{index: ise, output: y}]";
  for (const auto& [more, words] :
       {std::pair<std::string, std::string>{term + ", failure: 1e-9}\n",
                                            "all 12 points cost 1e-09, fitness.failure"},
        {term + "}\nset: {plant.matrix.elements.0.gain: 0}\n", "all 12 points cost the same"}}) {
    write("t.yaml", parameter + more);
    std::filesystem::remove_all(path("out"));
    const auto tuned = json("--out " + path("out"), 3);
    EXPECT_EQ(tuned["worse"], false);
    EXPECT_EQ(tuned["parameters"][0].count("at_bound"), 0U);
    EXPECT_NE(tuned["remarks"].dump().find(words), std::string::npos) << tuned["remarks"].dump();
    EXPECT_EQ(tuned["remarks"].dump().find("bound"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path("out") + "/lag_tuned.yaml"));
    const Outcome table = tool("tune " + files() + " --no-plot");
    EXPECT_EQ(table.code, 3);
    EXPECT_EQ(table.printed.rfind("nothing was found: " + words, 0), 0U) << table.printed;
  }
}

TEST_F(TuneTool, CtrlCSavesAndSaysHowToGoOn) {
  const std::string out = path("out");
  // The interrupt comes when the first generation stands in the state file.
  const std::string script = std::string(FMBPC_TOOL) + " tune " + files() +
                             " --no-plot --evaluations 100000 --out " + out + " >/dev/null 2>" +
                             path("errors") + " & P=$!; while ! [ -e " + out +
                             "/state.json ]; do kill -0 $P || exit 9; done; kill -INT $P; wait $P";
  const std::string command = "bash -c 'set -m; " + script + "' 2>/dev/null";
  const int code = WEXITSTATUS(std::system(command.c_str()));
  EXPECT_EQ(code, 130);
  std::ifstream errors(path("errors"));
  std::string line;
  std::getline(errors, line);
  EXPECT_NE(line.find("--resume"), std::string::npos) << line;
  const auto tuned = nlohmann::json::parse(std::ifstream(out + "/tuning.json"));
  EXPECT_EQ(tuned["complete"], false);
  EXPECT_GE(tuned["evaluations"].get<int>(), 8);
}

TEST_F(TuneTool, ComparesMethodsAtEqualEvaluations) {
  const auto compared = json("--compare --seeds 2 --methods apso,random --evaluations 24");
  ASSERT_EQ(compared["methods"].size(), 2U);
  for (const auto& method : compared["methods"]) {
    EXPECT_EQ(method["evaluations"], nlohmann::json::array({24, 24}));
    EXPECT_EQ(method["curves"][0].size(), 24U);
    EXPECT_TRUE(method["held_out_cost"]["median"].is_number());
  }
  const Outcome table =
      tool("tune " + files() + " --compare --seeds 1 --methods pso --evaluations 8");
  EXPECT_NE(table.printed.find("held out"), std::string::npos) << table.printed;
}

TEST_F(TuneTool, DrawsItsConvergence) {
  if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-matplotlib is not installed";
  const Outcome one = tool("tune " + files() + " --evaluations 8 --out " + path("one"), true);
  EXPECT_EQ(one.printed, "");
  EXPECT_TRUE(std::filesystem::exists(path("one") + "/convergence.png"));
}

TEST_F(TuneTool, MistakesAreOneLineOnStandardError) {
  for (const std::string arguments :
       {"nothing " + path("t.yaml"), path("lag.yaml") + " nothing", files() + " --method simplex",
        files() + " --evaluations 0", files() + " --resume", files() + " --threads -1",
        files() + " --seed -3", files() + " --set controller.loops.7.kp=1",
        files() + " --compare --seeds 0"}) {
    const Outcome outcome = tool("tune " + arguments, true);
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_EQ(outcome.printed.rfind("fmbpc: ", 0), 0U) << outcome.printed;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1)
        << outcome.printed;
  }
}

}  // namespace tool_tune_tool_test
}  // namespace fpc
