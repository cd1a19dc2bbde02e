// The tool as a person or a script calls it: what is printed, where, and the exit code.
#include <gtest/gtest.h>
#include <set>

#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "paths.hpp"
#include "runtime/loop_fixture.hpp"
#include "tool/tool_run.hpp"

namespace fpc {
namespace tool_tool_test {

using Tool = LoopFolder;
const std::string kShort = " --set sampling.duration_h=40";

TEST_F(Tool, JsonIsOneObjectAndNothingElse) {
  const Outcome one = tool("run asp_case1_clp --json" + kShort);
  EXPECT_EQ(one.code, 0);
  const auto json = nlohmann::json::parse(one.printed);
  EXPECT_EQ(json["loop"], "asp_case1_clp");
  EXPECT_EQ(json["steps"], 200);
  const auto two =
      nlohmann::json::parse(tool("run asp_case1 asp_case1_pi_s --json" + kShort).printed);
  EXPECT_EQ(two["loops"].size(), 2U);
  EXPECT_EQ(two["loops"][1]["loop"], "asp_case1_pi_s");
  const auto plants = nlohmann::json::parse(tool("plants --json").printed);
  EXPECT_EQ(plants["plants"][0]["name"], "activated_sludge");
  const auto controllers = nlohmann::json::parse(tool("controllers --json").printed)["controllers"];
  EXPECT_GE(controllers.size(), 8U);
  std::map<std::string, nlohmann::json> settings;
  for (const auto& one : controllers) settings[one["type"].get<std::string>()] = one["settings"];
  EXPECT_EQ(settings["pi"][0], "kp");
  EXPECT_NE(tool("controllers").printed.find("fuzzy_optimal"), std::string::npos);
}

TEST_F(Tool, NoBarIsDrawnWhereNobodyLooks) {
  EXPECT_EQ(tool("run asp_case1_pi_s" + kShort, true).printed, "");
}

TEST_F(Tool, TablesHaveUnitsALegendAndNoSwitchesOfAContinuousValve) {
  const std::string printed = tool("run asp_case1_pi_x" + kShort).printed;
  EXPECT_NE(printed.find("x [mg/l]"), std::string::npos) << printed;
  EXPECT_NE(printed.find("q_r [m3/h]"), std::string::npos) << printed;
  EXPECT_NE(printed.find("beyond: samples"), std::string::npos) << printed;
  EXPECT_NE(printed.find("  -  "), std::string::npos) << printed;
  const std::string valves = tool("run batch_fuzzy_eq45 --set sampling.duration_h=1").printed;
  const auto valve = valves.find("\n", valves.find("kM"));
  ASSERT_NE(valve, std::string::npos) << valves;
  const std::string on_off = valves.substr(valve, valves.find("\n", valve + 1) - valve);
  EXPECT_EQ(on_off.find("  -  "), std::string::npos) << valves;
}

TEST_F(Tool, StabilityPrintsNoMinusZero) {
  for (const char* subject : {"fm_1", "cstr_tracking"}) {
    const std::string printed =
        tool(std::string("stability ") + subject + " --horizon 1..9").printed;
    ASSERT_FALSE(printed.empty()) << subject;
    EXPECT_EQ(printed.find("-0.0000"), std::string::npos) << printed;
  }
}

TEST_F(Tool, SaysItsVersion) {
  const std::string printed = tool("--version").printed;
  EXPECT_EQ(printed.rfind("fmbpc 0.", 0), 0U) << printed;
}

TEST_F(Tool, SuggestsWhatWasMeant) {
  EXPECT_NE(tool("rnu asp_case1", true).printed.find("did you mean run?"), std::string::npos);
  const std::string loop = tool("run asp_caes1", true).printed;
  EXPECT_NE(loop.find("near: asp_case1"), std::string::npos) << loop;
  EXPECT_LT(loop.size(), 200U) << "not every loop there is";
}

TEST_F(Tool, HelpNamesTheToolAndGivesAnExampleOfEveryCommand) {
  const std::string all = tool("--help").printed;
  EXPECT_EQ(all.find("fmbpc_tool"), std::string::npos) << all;
  for (const char* command : {"run", "resolve", "evaluate", "identify", "validate", "loops",
                              "plants", "controllers", "model", "table", "stability", "reproduce",
                              "tune", "study", "replay", "recover", "watch", "page"}) {
    EXPECT_NE(all.find(command), std::string::npos) << command;
    const std::string help = tool(std::string(command) + " --help").printed;
    EXPECT_NE(help.find("Example: fmbpc " + std::string(command)), std::string::npos) << help;
    EXPECT_EQ(help.find('/' + std::string("fmbpc_tool")), std::string::npos) << help;
  }
}

/// Older CLI11 writes TEXT=word, newer TEXT [word].
bool showsDefault(const std::string& help, const std::string& word) {
  return help.find("=" + word) != std::string::npos ||
         help.find(" [" + word + "]") != std::string::npos;
}

TEST_F(Tool, HelpShowsDefaults) {
  const std::string identify = tool("identify --help").printed;
  for (const char* word : {"best", "90", "comma", "point", "1"})
    EXPECT_TRUE(showsDefault(identify, word)) << word << "\n" << identify;
  EXPECT_TRUE(showsDefault(tool("validate --help").printed, "10"));
  EXPECT_NE(tool("study --help").printed.find("(default: ise)"), std::string::npos);
}

TEST_F(Tool, LoopsAreListedByWords) {
  const auto json = nlohmann::json::parse(tool("loops column clp --json").printed);
  ASSERT_GE(json["loops"].size(), 4U);
  for (const auto& loop : json["loops"])
    EXPECT_EQ(
        std::set<std::string>({"distillation_column", "transfer_matrix"}).count(loop["plant"]), 1U);
  EXPECT_EQ(tool("loops zebra").code, 1);
  EXPECT_NE(tool("loops --names").printed.find("asp_case1\n"), std::string::npos);
}

TEST_F(Tool, MistakesAreOneLineOnStandardError) {
  for (const char* arguments :
       {"run nothing", "run asp_case1 --set loop.pace=brisk", "run asp_case1 --set nonsense",
        "resolve", "fly", "run asp_case1 --fast", "resolve asp_case1 --set controller.horizon=3",
        "model nothing.yaml", "", "run linear_2x2 --out ''", "study linear_2x2 --out ''",
        "run linear_2x2 --commands=''"}) {
    const Outcome outcome = tool(arguments, true);
    EXPECT_EQ(outcome.code, 1) << arguments;
    EXPECT_EQ(outcome.printed.rfind("fmbpc: ", 0), 0U) << outcome.printed;
    EXPECT_EQ(std::count(outcome.printed.begin(), outcome.printed.end(), '\n'), 1)
        << outcome.printed;
    EXPECT_EQ(tool(arguments).printed, "") << arguments;
  }
}

TEST_F(Tool, StdoutThatIsFullIsAnError) {
  for (const char* arguments : {"loops", "run linear_2x2 --json", "resolve asp_case1", "--help"}) {
    const Outcome outcome = shell(std::string(FMBPC_TOOL) + " " + arguments + " 2>&1 >/dev/full");
    EXPECT_NE(outcome.code, 0) << arguments;
    EXPECT_NE(outcome.printed.find("fmbpc: stdout: "), std::string::npos) << outcome.printed;
  }
}

TEST_F(Tool, ARunWhosePlantCannotBeMovedFails) {
  const std::string stuck = "run asp_case1_pi_x --set plant.integrator.max_steps=1" + kShort;
  const Outcome outcome = tool(stuck, true);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.printed.find("first sample 0: more integration steps"), std::string::npos)
      << outcome.printed;
  EXPECT_EQ(nlohmann::json::parse(tool(stuck + " --json").printed)["complete"], false);
}

// Its figures are none of the benchmark's, whoever reads them: no success.
TEST_F(Tool, ARunThatIsNotCompleteIsNoSuccessOfEvaluate) {
  const std::string folder = ::testing::TempDir() + "bsm1_incomplete";
  ASSERT_EQ(tool("run bsm1_own_open --no-plot --set sampling.duration_h=12 --set "
                 "report.record_from_h=0 --out " +
                 folder)
                .code,
            0);
  const std::string evaluate = "evaluate --json --from-h 0 " + folder;
  const Outcome whole = tool(evaluate);
  EXPECT_EQ(whole.code, 0);
  EXPECT_EQ(nlohmann::json::parse(whole.printed)["complete"], true);
  shell("sed -i 's/\"complete\": true/\"complete\": false/' " + folder + "/summary.json");
  const Outcome stopped = tool(evaluate);
  EXPECT_EQ(stopped.code, 1);
  EXPECT_EQ(nlohmann::json::parse(stopped.printed)["complete"], false);
}

TEST_F(Tool, ARunThatIsHeldThroughoutFails) {
  const std::string held =
      "run column_clip --set controller.coincidence_steps=1 --set sampling.duration_h=1";
  const Outcome outcome = tool(held);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.printed.find("never_controlled"), std::string::npos) << outcome.printed;
}

TEST_F(Tool, WhatALawSaysOfItselfStandsUnderTheTable) {
  const Outcome outcome =
      tool("run surge_tank_steps --set controller.horizon_steps=1 --set sampling.duration_h=0.005");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.printed.find("horizon_too_short"), std::string::npos) << outcome.printed;
}

TEST_F(Tool, StabilityOfAMatrixOfTheLoopFileIsOfThatPlant) {
  const Outcome outcome = tool("stability heated_tank --json");
  ASSERT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.printed.find("heat"), std::string::npos);
  EXPECT_EQ(outcome.printed.find("y_D"), std::string::npos) << outcome.printed;
}

// Steady states of a linear plant lie on a straight line: no fold, no turning point.
TEST_F(Tool, StabilityOfALinearPlantHasNoTurningPoints) {
  for (const char* loop : {"column_imc", "heated_tank"}) {
    const Outcome outcome = tool(std::string("stability --json ") + loop);
    ASSERT_EQ(outcome.code, 0) << loop;
    const auto states = nlohmann::json::parse(outcome.printed)["steady_states"];
    ASSERT_EQ(states["branches"].size(), 1U) << loop;
    EXPECT_EQ(states["branches"][0]["special"].size(), 0U) << loop;
    EXPECT_GE(states["branches"][0]["points"].size(), 2U) << loop;
  }
}

TEST_F(Tool, ResolvePrintsTheTextThatNodesRead) {
  const Outcome outcome = tool("resolve asp_case1_pi_x");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.printed, resolveLoop("asp_case1_pi_x"));
}

TEST_F(Tool, OutHoldsTheFilesOfEveryLoop) {
  const Outcome one = tool("run asp_case1_pi_s --no-plot --out " + path("one") + kShort);
  EXPECT_EQ(one.code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("one/trajectory.csv")));
  EXPECT_TRUE(std::filesystem::exists(path("one/summary.json")));
  EXPECT_FALSE(std::filesystem::exists(path("one/plot.png")));
  tool("run asp_case1 asp_case1_pi_s --no-plot --out " + path("two") + kShort);
  EXPECT_TRUE(std::filesystem::exists(path("two/asp_case1/summary.json")));
  EXPECT_TRUE(std::filesystem::exists(path("two/asp_case1_pi_s/summary.json")));
}

TEST_F(Tool, OutDrawsAPicture) {
  if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-matplotlib is not installed";
  EXPECT_EQ(tool("run asp_case1_clp --out " + folder_.string() + kShort, true).printed, "");
  std::ifstream picture(path("plot.png"), std::ios::binary);
  std::array<char, 4> start{};
  picture.read(start.data(), start.size());
  EXPECT_EQ(std::string(start.data() + 1, 3), "PNG");
}

TEST_F(Tool, ShippedRecordsAreWhatTheirScriptsPrint) {
  const std::string top = sourceDir();
  for (const std::string name : {"influent_week", "reaction_rates"}) {
    const std::string command = "/usr/bin/python3 " + top + "/bench/made_records.py " + name +
                                " | cmp - " + top + "/config/data/" + name + ".csv";
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
  }
}

TEST_F(Tool, StabilityJsonHoldsRulesHorizonsCertificateAndSteadyStates) {
  const Outcome outcome = tool("stability cstr_tracking --json --horizon 1..12");
  ASSERT_EQ(outcome.code, 0);
  const auto json = nlohmann::json::parse(outcome.printed);
  EXPECT_EQ(json["rules"].size(), 6U);
  EXPECT_EQ(json["horizon"].size(), 12U);
  EXPECT_TRUE(json["certificate"].contains("status"));
  int folds = 0;
  for (const auto& point : json["steady_states"]["branches"][0]["special"])
    folds += point["kind"] == "fold";
  EXPECT_EQ(folds, 2);
  EXPECT_EQ(tool("stability fm_2 --horizon 1..3 --json").code, 0);
  for (const char* wrong : {"stability nothing", "stability fm_1 --horizon 3",
                            "stability fm_1 --at x", "stability fm_1 --at height=3"})
    EXPECT_EQ(tool(wrong).code, 1) << wrong;
}

TEST_F(Tool, StabilitySaysThatItDoesNotAnalyseThePrintedStateSpace) {
  const auto note = [&](const std::string& loop) {
    const Outcome outcome = tool("stability " + loop + " --json --horizon 9..9");
    EXPECT_EQ(outcome.code, 0) << loop;
    return nlohmann::json::parse(outcome.printed).value("note", "");
  };
  EXPECT_NE(note("cstr_tracking_literal").find("literal"), std::string::npos);
  EXPECT_EQ(note("cstr_tracking"), "");
}

TEST_F(Tool, ReproduceJsonIsAListOfRowsWithAVerdictEach) {
  const auto json =
      nlohmann::json::parse(tool("reproduce asp2_table_8 asp2_equations --json").printed);
  EXPECT_EQ(
      tool("reproduce asp2_table_8 cstr_propositions", true).printed,
      "fmbpc: reproduce: blazic2007, from 1 of 2\nfmbpc: reproduce: vallejo2021a, from 2 of 2\n")
      << "a log shows that something is done";
  ASSERT_TRUE(json.is_array());
  ASSERT_EQ(json.size(), 16U);
  for (const auto& row : json)
    for (const char* key : {"name", "paper_key", "item", "quantity", "kind", "paper", "here",
                            "lowest", "highest", "runs", "unit", "verdict", "note", "behind"})
      EXPECT_TRUE(row.contains(key)) << key;
  EXPECT_EQ(json[0]["name"], "asp2_equations_66_73");
  EXPECT_EQ(json[0]["verdict"], "not_reproduced");  // the sign in H = 6
  EXPECT_NEAR(json[0]["here"].get<double>(), -0.868240, 1e-6);
}

TEST_F(Tool, ReproduceTakesPapersExperimentsAndLoops) {
  EXPECT_GE(nlohmann::json::parse(tool("reproduce --list --json").printed).size(), 81U);
  const auto named = [&](const std::string& what) {
    return nlohmann::json::parse(tool("reproduce --list --json " + what).printed).size();
  };
  EXPECT_EQ(named("cstr_figure_2"), 1U);
  EXPECT_EQ(named("surge_tank_disturbance"), 1U);
  EXPECT_GT(named("mekki"), 8U);
  EXPECT_EQ(tool("reproduce nothing").code, 1);
}

TEST_F(Tool, ReproducePrintsASummaryOfEachPaperBelowTheDetailsAskedFor) {
  const std::string printed = tool("reproduce asp2_table_7").printed;
  EXPECT_NE(printed.find("formula (59)"), std::string::npos) << printed;
  EXPECT_NE(printed.find("in all: 9 holds"), std::string::npos) << printed;
}

TEST_F(Tool, ReproduceWritesWhatAPictureNeeds) {
  const std::string folder = ::testing::TempDir() + "reproduce_plots";
  EXPECT_EQ(tool("reproduce cstr_figure_1 --plots " + folder).code, 0);
  std::ifstream stream(folder + "/cstr_figure_1.json");
  const auto json = nlohmann::json::parse(stream);
  EXPECT_EQ(json["panels"][0]["curves"].size(), 6U);
  EXPECT_GE(json["rows"].size(), 4U);
}

}  // namespace tool_tool_test
}  // namespace fpc
