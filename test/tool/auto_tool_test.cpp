// fmbpc identify --auto and fmbpc validate on a record that is known.
#include <gtest/gtest.h>

#include "fmbpc/config/identified_file.hpp"
#include "tool/identify_fixture.hpp"

namespace fpc {
namespace {

class AutoTool : public IdentifyTool {
 protected:
  std::string search(const std::string& rest) const {
    return "identify " + data_ + " --auto --inputs u --outputs y --kind regressors " + rest;
  }
};

TEST_F(AutoTool, FindsTheProcessAndJudgesItsFileAlike) {
  const std::string model = path("found.yaml");
  const Outcome outcome =
      tool(search("--rows 1:200 --validate-rows 201:300 --out " + model + " --json"));
  ASSERT_EQ(outcome.code, 0);
  const auto found = parsed(outcome.printed);
  EXPECT_TRUE(found.at("beats_linear").at("y").get<bool>()) << found.at("verdict");
  EXPECT_EQ(found.at("cross_validation").at("y").at("best"), "regressors");
  const auto& held = found.at("validation").at("y");
  EXPECT_LT(held.at("free_run").at("rmse").get<double>(),
            0.5 * held.at("linear").at("free_run").at("rmse").get<double>());
  EXPECT_EQ(held.at("free_run"), held.at("regressors").at("free_run"));

  const Outcome again = tool("validate " + model + " " + data_ + " --rows 201:300 --json");
  ASSERT_EQ(again.code, 0);
  EXPECT_EQ(parsed(again.printed).at("validation").at("y"), held);
  EXPECT_EQ(readIdentified(model).model.sample_time_s, 1.0);
}

TEST_F(AutoTool, PrintsTheVerdictFirst) {
  const Outcome outcome = tool(search("--rows 1:120 --budget 2"));
  ASSERT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.printed.rfind("y: ", 0), 0U);
  EXPECT_LT(outcome.printed.find("beat"), outcome.printed.find('\n'));
}

TEST_F(AutoTool, ValidateTakesOtherNames) {
  const std::string model = path("plain.yaml");
  ASSERT_EQ(tool(onRecord("--out " + model)).code, 0);
  CsvTable other = record(100);
  other.names = {"time", "level", "valve"};
  const std::string file = writeRecord("other.csv", other);
  EXPECT_NE(tool("validate " + model + " " + file).code, 0);
  const Outcome outcome =
      tool("validate " + model + " " + file + " --columns y=level,u=valve --steps 3 --json");
  ASSERT_EQ(outcome.code, 0);
  const auto json = parsed(outcome.printed);
  EXPECT_EQ(json.at("validation").at("y").at("ahead").at("steps"), 3);
  EXPECT_FALSE(json.at("validation").at("y").contains("linear"));
}

TEST_F(AutoTool, SaysWhatIsMissing) {
  EXPECT_NE(tool("identify " + data_ + " --auto --inputs u").code, 0);
  EXPECT_NE(tool("identify " + data_ + " --auto --outputs y").code, 0);
  EXPECT_NE(tool("identify " + data_ + " --auto --inputs nothing --outputs y").code, 0);
  EXPECT_NE(tool("identify " + data_).code, 0);
}

}  // namespace
}  // namespace fpc
