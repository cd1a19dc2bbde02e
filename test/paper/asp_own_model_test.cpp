// The activated-sludge loops with models of our own (vallejo2021thesis, articles 1 and 2), and
// what these models come from: the shipped files are what identification gives from the record of
// the shipped experiment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "identification/identify.hpp"
#include "paths.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_asp_own_model_test {

struct Weeks {
  std::vector<double> ise_s, ise_x, move;
  std::uint64_t violations{};
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double iseOf(const Summary& summary, const std::string& output) {
  const auto at = std::find(summary.output_names.begin(), summary.output_names.end(), output);
  return summary.outputs[static_cast<std::size_t>(at - summary.output_names.begin())].ise;
}

Weeks runWeeks(const std::string& name, int first, int last) {
  Weeks weeks;
  for (int seed = first; seed <= last; ++seed) {
    const LoopFile loop = readLoop(name, {{"seed", std::to_string(seed)}});
    const RunRecord record = runLoop(loop);
    EXPECT_TRUE(record.complete) << name;
    const Summary summary = summarize(loop, record, 0.0);
    weeks.ise_s.push_back(iseOf(summary, "s"));
    weeks.ise_x.push_back(iseOf(summary, "x"));
    weeks.move.push_back(summary.inputs[0].mean_abs_move);
    weeks.violations += summary.input_violations + summary.move_violations;
  }
  std::printf("%-22s median: ISE x %.4g, ISE s %.4g, mean move %.1f\n", name.c_str(),
              median(weeks.ise_x), median(weeks.ise_s), median(weeks.move));
  return weeks;
}

/// Biomass ISE against both baselines, median of seeds 1-8.
void expectBelow(const std::string& loop, const std::string& baseline, double of_pi_s,
                 double of_pi_x) {
  const Weeks own = runWeeks(loop, 1, 8), pi_s = runWeeks(baseline + "_pi_s", 1, 8),
              pi_x = runWeeks(baseline + "_pi_x", 1, 8);
  EXPECT_LE(median(own.ise_x), of_pi_s * median(pi_s.ise_x)) << loop;
  EXPECT_LE(median(own.ise_x), of_pi_x * median(pi_x.ise_x)) << loop;
  const double ratio_s = median(own.ise_s) / median(pi_s.ise_s);
  EXPECT_GE(ratio_s, 0.8) << loop;
  EXPECT_LE(ratio_s, 1.15) << loop;
  EXPECT_EQ(own.violations, 0U) << loop;
}

TEST(AspOwnModel, CaseCBeatsPiByTheStatedMargins) {
  expectBelow("asp_case_c_own", "asp_case_c", 0.05, 0.5);
}

TEST(AspOwnModel, Case1BeatsPiByTheStatedMargins) {
  expectBelow("asp_case1_own", "asp_case1", 0.1, 0.5);
}

TEST(AspOwnModel, CaseDBeatsPiByTheStatedMargins) {
  expectBelow("asp_case_d_own", "asp_case_d", 0.05, 0.3);
}

TEST(AspOwnModel, CasesAAndBFollowTheBiomassBetterThanPi) {
  for (const std::string name : {"asp_case_a", "asp_case_b"}) {
    const Weeks own = runWeeks(name, 1, 8), pi_s = runWeeks(name + "_pi_s", 1, 8),
                pi_x = runWeeks(name + "_pi_x", 1, 8);
    EXPECT_LT(median(own.ise_x), median(pi_s.ise_x)) << name;
    EXPECT_LT(median(own.ise_x), median(pi_x.ise_x)) << name;
    EXPECT_EQ(own.violations, 0U) << name;
  }
}

// Settings were chosen on seeds 1-4.
TEST(AspBest, BeatsTheTunedPiByAQuarterAtNoMoreMoveOnSeeds5To8) {
  const Weeks best = runWeeks("asp_best", 5, 8), baseline = runWeeks("asp_case1_pi_x_tuned", 5, 8);
  EXPECT_LE(median(best.ise_x), 0.75 * median(baseline.ise_x));
  EXPECT_LE(median(best.move), median(baseline.move));
  EXPECT_EQ(best.violations, 0U);
}

void expectNear(double found, double shipped, const std::string& where) {
  EXPECT_NEAR(found, shipped, 1e-6 * std::max(1.0, std::abs(shipped))) << where;
}

TEST(AspOwnModel, TheShippedFilesAreWhatIdentificationGivesFromTheShippedExperiment) {
  const LoopFile loop = readLoop("asp_excite");
  const RunRecord record = runLoop(loop);
  const std::string folder = resultsDir() + "/asp_excite_own";
  writeRun(loop, record, summarize(loop, record, 0.0), folder);
  const CsvTable table = readCsv(folder + "/trajectory.csv");
  const std::string config = sourceDir() + "/config";
  for (const std::string name : {"asp_a", "asp_b", "asp_c", "asp_d", "asp_xr"}) {
    SCOPED_TRACE(name);
    const Structure structure = readStructure(config + "/structure/" + name + ".yaml");
    const TsModel found = identify(makeDataSet(table, structure), structure).model;
    const TsModel shipped = readModel(config + "/model/" + name + ".yaml");
    ASSERT_EQ(found.submodels.size(), shipped.submodels.size());
    for (std::size_t i = 0; i < found.submodels.size(); ++i) {
      const auto &a = found.submodels[i].rules, &b = shipped.submodels[i].rules;
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t r = 0; r < a.size(); ++r) {
        const std::string where = shipped.outputs[i].name + " " + std::to_string(r);
        expectNear(a[r].offset, b[r].offset, where);
        for (Eigen::Index j = 0; j < a[r].coefficients.size(); ++j)
          expectNear(a[r].coefficients[j], b[r].coefficients[j], where);
        for (std::size_t m = 0; m < a[r].antecedents.size(); ++m)
          for (std::size_t p = 0; p < a[r].antecedents[m].parameters.size(); ++p)
            expectNear(a[r].antecedents[m].parameters[p], b[r].antecedents[m].parameters[p], where);
      }
    }
  }
}

}  // namespace paper_asp_own_model_test
}  // namespace fpc
