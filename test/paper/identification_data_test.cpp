// Public records: what other implementations reach on them is reached. Skipped without
// ${FMBPC_DATA}.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "config/structure_file.hpp"
#include "identification/identify.hpp"
#include "identification/validation.hpp"
#include "paths.hpp"

namespace fpc {
namespace paper_identification_data_test {

class PublicRecord : public ::testing::Test {
 protected:
  /// Takes a shipped structure and a record; skips if the record is not there.
  void open(const std::string& structure, const std::string& file) {
    const char* folder = std::getenv("FMBPC_DATA");
    if (folder == nullptr || !std::filesystem::exists(std::string(folder) + "/" + file))
      GTEST_SKIP() << file << " needs ${FMBPC_DATA}";
    structure_ = readStructure(sourceDir() + "/config/structure/" + structure + ".yaml");
    table_ = readCsv(std::string(folder) + "/" + file);
  }
  DataSet rows(const std::string& range) const {
    return makeDataSet(table_, structure_, parseRows(range));
  }

  Structure structure_;
  CsvTable table_;
};

TEST_F(PublicRecord, CstrFreeRunsFitHeldOutDataFarBetterThanALinearModel) {
  open("daisy_cstr", "daisy_cstr.csv");
  if (IsSkipped()) return;
  const auto found = identify(rows("1:5000"), structure_);
  const auto held_out = validateModel(found.model, found.linear, rows("5001:7500"));
  EXPECT_GE(held_out[0].free_run.fit, 91.0);
  EXPECT_GE(held_out[1].free_run.fit, 95.0);
  EXPECT_NEAR(held_out[0].linear_free_run.fit, 81.6, 0.1);
  EXPECT_NEAR(held_out[1].linear_free_run.fit, 91.5, 0.1);
}

TEST_F(PublicRecord, CstrWithMultivariateMembershipsBeatsTheLinearModelOnHeldOutData) {
  open("daisy_cstr", "daisy_cstr.csv");
  if (IsSkipped()) return;
  std::vector<OutputValidation> held_out[2];
  for (const bool multivariate : {false, true}) {
    structure_.partition.multivariate = multivariate;
    const auto found = identify(rows("1:5000"), structure_);
    held_out[multivariate] = validateModel(found.model, found.linear, rows("5001:7500"));
    for (const auto& output : held_out[multivariate])
      std::printf("%s %s: free-run VAF %.2f %%, linear %.2f %%\n",
                  multivariate ? "multivariate" : "projected", output.output.c_str(),
                  output.free_run.vaf, output.linear_free_run.vaf);
  }
  EXPECT_GE(held_out[1][0].free_run.fit, 91.0);
  EXPECT_GT(held_out[1][1].free_run.fit, held_out[1][1].linear_free_run.fit + 2.0);
}

struct Furnace {
  const char* structure;
  double mse, linear_mse;
  const char* first_200;  ///< rows that give 200 usable ones
};

class GasFurnace : public PublicRecord, public ::testing::WithParamInterface<Furnace> {};

TEST_P(GasFurnace, TwoToFourRulesBeatTheLinearModelInSample) {
  open(GetParam().structure, "box_jenkins_gas_furnace.csv");
  if (IsSkipped()) return;
  const auto found = identify(rows("1:"), structure_);
  const auto figures = validateModel(found.model, found.linear, rows("1:"));
  EXPECT_GE(found.model.submodels[0].rules.size(), 2U);
  EXPECT_LE(found.model.submodels[0].rules.size(), 4U);
  EXPECT_LE(figures[0].one_step.mse, GetParam().mse);
  EXPECT_NEAR(figures[0].linear_one_step.mse, GetParam().linear_mse, 5e-5);
}

TEST_P(GasFurnace, TheHeldOutRestIsPredictedAboutAsWellAsByTheLinearModel) {
  open(GetParam().structure, "box_jenkins_gas_furnace.csv");
  if (IsSkipped()) return;
  const auto found = identify(rows(GetParam().first_200), structure_);
  EXPECT_EQ(found.outputs[0].samples, 200);
  const auto rest = validateModel(found.model, found.linear, rows("201:"));
  EXPECT_LE(rest[0].one_step.rmse, 1.10 * rest[0].linear_one_step.rmse);
}

INSTANTIATE_TEST_SUITE_P(, GasFurnace,
                         ::testing::Values(Furnace{"box_jenkins_2", 0.166, 0.1759, "1:204"},
                                           Furnace{"box_jenkins_6", 0.058, 0.0616, "1:203"}),
                         [](const auto& furnace) { return std::string(furnace.param.structure); });

class CascadedTanks : public PublicRecord,
                      public ::testing::WithParamInterface<std::pair<const char*, const char*>> {};

TEST_P(CascadedTanks, OneStepAndFreeRunErrorsAreSmallOnTheHeldOutPart) {
  open("cascaded_tanks", "cascaded_tanks_estimation.csv");
  if (IsSkipped()) return;
  const auto found = identify(rows(GetParam().first), structure_);
  const auto held_out = validateModel(found.model, found.linear, rows(GetParam().second));
  EXPECT_LE(held_out[0].one_step.rmse, 0.055);
  EXPECT_LE(held_out[0].free_run.rmse, 0.70);
  EXPECT_LT(held_out[0].free_run.rmse, held_out[0].linear_free_run.rmse);
}

using Split = std::pair<const char*, const char*>;
INSTANTIATE_TEST_SUITE_P(, CascadedTanks,
                         ::testing::Values(Split{"1:512", "513:1024"}, Split{"1:600", "601:1024"},
                                           Split{"1:700", "701:1024"}, Split{"1:768", "769:1024"}));

}  // namespace paper_identification_data_test
}  // namespace fpc
