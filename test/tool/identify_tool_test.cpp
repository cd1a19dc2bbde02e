// fmbpc identify on a record that is known: what is printed, what is written.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "identification/validation.hpp"
#include "tool/identify_fixture.hpp"

namespace fpc {
namespace tool_identify_tool_test {

std::string contents(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(IdentifyTool, JsonIsOneObjectWithTheDocumentedKeys) {
  const Outcome outcome = tool(onRecord("--rows 1:200 --validate-rows 201:300 --json"));
  ASSERT_EQ(outcome.code, 0);
  const auto json = parsed(outcome.printed);
  for (const char* part : {"identification", "validation"})
    for (const char* run : {"one_step", "free_run"})
      for (const char* figure : {"rmse", "mse", "vaf", "fit"}) {
        const auto& own = json.at(part).at("y");
        EXPECT_TRUE(own.at(run).at(figure).is_number()) << part << run << figure;
        const double linear = json.at(part).at("linear").at("y").at(run).at(figure);
        EXPECT_EQ(own.at("linear").at(run).at(figure), linear);
      }
  EXPECT_EQ(json.at("rules").at("y"), 3);
  EXPECT_GE(json.at("seconds").get<double>(), 0.0);
  EXPECT_EQ(json.at("rule_details").at("y").size(), 3U);
  const auto& held_out = json.at("validation").at("y");
  EXPECT_GT(held_out.at("free_run").at("vaf"), held_out.at("linear").at("free_run").at("vaf"));
  EXPECT_EQ(held_out.at("one_step").at("samples"), 99);
}

TEST_F(IdentifyTool, JsonFiguresAreThoseOfTheLibrary) {
  const auto json = parsed(tool(onRecord("--rows :200 --validate-rows 201: --json")).printed);
  const Structure structure = readStructure(structure_);
  const auto rows = [&](const char* range) {
    return makeDataSet(readCsv(data_), structure, parseRows(range));
  };
  const auto found = identify(rows("1:200"), structure);
  const auto figures = validateModel(found.model, found.linear, rows("201:300"));
  EXPECT_EQ(json["validation"]["y"]["one_step"]["rmse"], figures[0].one_step.rmse);
  EXPECT_EQ(json["validation"]["y"]["free_run"]["fit"], figures[0].free_run.fit);
  EXPECT_EQ(json["validation"]["linear"]["y"]["free_run"]["mse"], figures[0].linear_free_run.mse);
}

TEST_F(IdentifyTool, WithoutHeldOutDataValidationIsNullAndTheTextSaysSo) {
  EXPECT_TRUE(parsed(tool(onRecord("--json")).printed).at("validation").is_null());
  const Outcome outcome = tool(onRecord(""));
  EXPECT_NE(outcome.printed.find("no held-out data"), std::string::npos);
  EXPECT_NE(outcome.printed.find("y [mg/l]"), std::string::npos);
  EXPECT_NE(outcome.printed.find("linear"), std::string::npos);
}

TEST_F(IdentifyTool, ValidationOnIdentificationRowsIsCalledSo) {
  const auto overlaps = [&](const std::string& rest) {
    return tool(onRecord(rest)).printed.find("not held out") != std::string::npos;
  };
  EXPECT_TRUE(overlaps("--rows :200 --validate-rows 200:"));
  EXPECT_TRUE(overlaps("--validate " + data_));
  EXPECT_FALSE(overlaps("--rows :200 --validate-rows 201:"));
  EXPECT_FALSE(overlaps("--rows 101: --validate " + data_ + " --validate-rows :100"));
}

TEST_F(IdentifyTool, ModelFileIsLosslessAndKeepsItsProvenanceWithoutPaths) {
  const std::string model = path("model.yaml");
  ASSERT_EQ(tool(onRecord("--rows 1:200 --out " + model)).code, 0);
  const std::string text = contents(model);
  EXPECT_EQ(writeModel(readModel(model)), text);
  const Structure structure = readStructure(structure_);
  const auto found =
      identify(makeDataSet(readCsv(data_), structure, parseRows("1:200")), structure);
  const TsModel read = readModel(model);
  for (std::size_t r = 0; r < 3; ++r) {
    EXPECT_EQ(read.submodels[0].rules[r].coefficients,
              found.model.submodels[0].rules[r].coefficients);
    EXPECT_EQ(read.submodels[0].rules[r].antecedents,
              found.model.submodels[0].rules[r].antecedents);
  }
  for (const char* word : {"data.csv rows 1:200", "structure known", "Gustafson-Kessel", "seed 1"})
    EXPECT_NE(read.source.find(word), std::string::npos) << read.source;
  EXPECT_EQ(text.find(folder_.string()), std::string::npos);
  ASSERT_EQ(tool(onRecord("--rows 1:200 --out " + model)).code, 0);  // replaces it
  EXPECT_EQ(contents(model), text);
}

TEST_F(IdentifyTool, PlotsAreDrawnAndTheirDataWritten) {
  if (std::system("/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") != 0)
    GTEST_SKIP() << "python3-matplotlib is not installed";
  const Outcome outcome =
      tool(onRecord("--rows :200 --validate-rows 201: --plots " + path("plots")), true);
  EXPECT_EQ(outcome.printed, "");
  for (const char* name : {"memberships.png", "prediction.png", "residuals.png"})
    EXPECT_EQ(contents(path("plots/") + name).substr(1, 3), "PNG") << name;
  const CsvTable table = readCsv(path("plots/validation.csv"));
  EXPECT_EQ(table.rows(), 100);
  EXPECT_EQ(table.missing(table.column("y_free_run")), 1);
}

TEST_F(IdentifyTool, InterruptedItEndsWithAnErrorAndWritesNothing) {
  writeRecord("long.csv", record(20000));
  write("slow.yaml", kStructure + "partition: {restarts: 100000}\n");  // would take hours
  const std::string model = path("model.yaml");
  const std::string command = "timeout --preserve-status -s INT 2 " + std::string(FMBPC_TOOL) +
                              " identify " + path("long.csv") + " " + path("slow.yaml") +
                              " --out " + model + " --json >" + path("out") + " 2>" + path("err");
  const int status = std::system(command.c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_EQ(contents(path("out")), "");
  EXPECT_NE(contents(path("err")).find("interrupted"), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find("model.yaml"), std::string::npos) << entry.path();
}

}  // namespace tool_identify_tool_test
}  // namespace fpc
