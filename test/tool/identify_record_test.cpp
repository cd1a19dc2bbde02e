// fmbpc identify on records as users have them: a written run, public data.
#include <gtest/gtest.h>

#include "tool/identify_fixture.hpp"

namespace fpc {
namespace tool_identify_record_test {

using IdentifyRecord = IdentifyTool;

TEST_F(IdentifyRecord, AWrittenRunGivesAModelThatClosesTheLoop) {
  ASSERT_EQ(tool("run asp_case1 --no-plot --out " + path("run")).code, 0);
  const Outcome outcome = tool("identify " + path("run/trajectory.csv") + " asp_c --rows :600 " +
                               "--validate-rows 601: --json --out " + path("own.yaml"));
  ASSERT_EQ(outcome.code, 0);
  const auto json = parsed(outcome.printed);
  EXPECT_GT(json["validation"]["s"]["free_run"]["vaf"], 97.0);
  EXPECT_EQ(json["rules"]["s"], 6);
  EXPECT_EQ(json["rules"]["x"], 5);
  const Outcome loop = tool("run asp_case1 --json --set sampling.duration_h=20 --set model.file=" +
                            path("own.yaml"));
  EXPECT_EQ(loop.code, 0);
  EXPECT_EQ(parsed(loop.printed)["steps"], 100);
}

TEST_F(IdentifyRecord, CstrFitsHeldOutDataAsTheBestPublishedModels) {
  if (!hasRecords()) GTEST_SKIP() << "needs ${FMBPC_DATA}";
  const Outcome outcome = tool(
      "identify ${FMBPC_DATA}/daisy_cstr.csv daisy_cstr --rows 1:5000 --validate-rows "
      "5001:7500 --json");
  ASSERT_EQ(outcome.code, 0);
  const auto held_out = parsed(outcome.printed)["validation"];
  EXPECT_GE(held_out["Ca"]["free_run"]["fit"], 91.0);
  EXPECT_GE(held_out["T"]["free_run"]["fit"], 95.0);
  EXPECT_NEAR(held_out["linear"]["Ca"]["free_run"]["fit"].get<double>(), 81.6, 0.1);
  EXPECT_NEAR(held_out["linear"]["T"]["free_run"]["fit"].get<double>(), 91.5, 0.1);
}

TEST_F(IdentifyRecord, GasFurnaceBeatsTheLinearModelInSample) {
  if (!hasRecords()) GTEST_SKIP() << "needs ${FMBPC_DATA}";
  for (const auto& [name, most] : {std::pair{"box_jenkins_2", 0.166}, {"box_jenkins_6", 0.058}}) {
    const Outcome outcome =
        tool("identify ${FMBPC_DATA}/box_jenkins_gas_furnace.csv " + std::string(name) + " --json");
    ASSERT_EQ(outcome.code, 0);
    EXPECT_LE(parsed(outcome.printed)["identification"]["co2"]["one_step"]["mse"], most);
  }
}

TEST_F(IdentifyRecord, CascadedTanksFollowTheirOwnHeldOutPart) {
  if (!hasRecords()) GTEST_SKIP() << "needs ${FMBPC_DATA}";
  const Outcome outcome = tool(
      "identify ${FMBPC_DATA}/cascaded_tanks_estimation.csv cascaded_tanks --rows 1:700 "
      "--validate-rows 701:1024 --json");
  ASSERT_EQ(outcome.code, 0);
  const auto held_out = parsed(outcome.printed)["validation"]["level"];
  EXPECT_LE(held_out["one_step"]["rmse"], 0.055);
  EXPECT_LE(held_out["free_run"]["rmse"], 0.70);
}

}  // namespace tool_identify_record_test
}  // namespace fpc
