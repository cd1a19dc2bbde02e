// The hybrid fuzzy model of the batch reactor identified per rule and operating mode (karer2007,
// eqs. 14-20). The figures are those of an independent numerical reference; every figure is
// printed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "config/structure_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "fmbpc/model/model_match.hpp"
#include "fmbpc/plant/plant.hpp"
#include "identification/identify.hpp"
#include "identification/prediction.hpp"
#include "model/choice_model.hpp"
#include "paths.hpp"
#include "plant/integrator.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_identification_batch_test {

constexpr int kSamples = 5000;

Structure structureOf() {
  return readStructure(sourceDir() + "/config/structure/batch_reactor.yaml");
}

struct Excitation {
  int hold_longest{15};
  bool cold_full_only{false};  // as eq. 43: cold water comes with kM = 1 only
  unsigned seed{1};
};

/// Columns T, Tw, kM, kC, kH: mode and mixing valve independent and uniform, held 1..15 samples.
Matrix excite(const Excitation& how) {
  std::mt19937_64 generator(how.seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto plant = makePlant("batch_reactor");
  IntegratorParams tight;
  tight.relative_tolerance = tight.absolute_tolerance = 1e-11;
  Integrator integrator(*plant, tight);
  Matrix values(kSamples + 1, 5);
  Vector x = Eigen::Vector2d(20.0, 20.0);
  Eigen::Vector3d u;
  int left = 0;
  for (Eigen::Index k = 0; k <= kSamples; ++k) {
    if (left-- == 0) {
      const bool hot = unit(generator) < 0.5;
      const double positions[] = {0.0, 0.01, 0.02, 0.05, 0.1, 1.0};
      u << positions[generator() % 6], (hot ? 0.0 : 1.0), (hot ? 1.0 : 0.0);
      if (how.cold_full_only && !hot) u[0] = 1.0;
      left = static_cast<int>(generator() % static_cast<unsigned>(how.hold_longest));
    }
    values.row(k) << x.transpose(), u.transpose();
    EXPECT_TRUE(integrator.advance(x, u, Eigen::Vector3d(12.0, 75.0, 20.0), 10.0).ok());
  }
  return values;
}

double rms(const Vector& v) { return std::sqrt(v.squaredNorm() / static_cast<double>(v.size())); }

/// Errors of T after 60 steps from every tenth sample, inputs as recorded.
double sixtyStepRms(const TsModel& model, const Matrix& values) {
  const Eigen::Index n = values.rows();
  ChoiceModel steps(model, values.rightCols(3).transpose());
  std::vector<double> errors;
  for (Eigen::Index k = 0; k + 60 < n; k += 10) {
    Vector state = values.row(k).head(2).transpose();
    for (Eigen::Index j = 0; j < 60; ++j) steps.step(static_cast<int>(k + j), Vector(0), state);
    errors.push_back(state[0] - values(k + 60, 0));
  }
  return rms(Eigen::Map<const Vector>(errors.data(), static_cast<Eigen::Index>(errors.size())));
}

double oneStepRms(const TsModel& model, const DataSet& data) {
  const Matrix predicted = predictOneStep(model, data);
  return rms(predicted.col(1).tail(kSamples) - data.values.col(1).tail(kSamples));
}

TEST(IdentificationBatch, PerRuleAndModeItPredictsAsTheReferenceDoes) {
  const Structure structure = structureOf();
  const Matrix values = excite({});
  const DataSet data = makeDataSet(values, structure, "simulated");
  const Identification found = identify(data, structure);
  const double one = oneStepRms(found.model, data), sixty = sixtyStepRms(found.model, values);
  std::printf("per rule and mode: one-step rms of Tw %.3f, 60-step rms of T %.3f\n", one, sixty);
  EXPECT_NEAR(one, 0.19, 0.04);
  EXPECT_NEAR(sixty, 0.107, 0.04);
  for (const auto& rule : found.outputs[1].rules) EXPECT_EQ(rule.status, RuleStatus::kFitted);

  Structure global = structure;
  global.consequents.method = ConsequentMethod::kGlobal;
  const Identification all = identify(data, global);
  const double one_all = oneStepRms(all.model, data), sixty_all = sixtyStepRms(all.model, values);
  std::printf("all rules at once: one-step rms of Tw %.3f, 60-step rms of T %.3f\n", one_all,
              sixty_all);
  EXPECT_LT(one_all, one);
  EXPECT_NEAR(one_all, 0.060, 0.02);
}

/// One rule per mode, that of 40 degC: as the published linear baseline.
TsModel linearOf(const TsModel& fuzzy) {
  TsModel model = fuzzy;
  OutputModel& Tw = model.submodels[1];
  Tw.antecedents.pop_back();
  Tw.rules = {Tw.rules[2], Tw.rules[7]};
  for (Rule& rule : Tw.rules) rule.antecedents.pop_back();
  return model;
}

/// Steady rms at 62, 26 and 35 degC of the loop of eq. 45 with this model.
std::vector<double> steadyRms(const TsModel& model) {
  LoopFile loop = readLoop("batch_fuzzy_eq45");
  loop.model = matchToPlant(model, loop.plant_info);
  const Summary summary = summarize(loop, runLoop(loop), 0.0);
  std::vector<double> rms;
  for (const WindowIndices& window : summary.windows) rms.push_back(window.rmse);
  std::printf("%-22s steady rms %.3f %.3f %.3f\n", model.name.c_str(), rms[0], rms[1], rms[2]);
  return rms;
}

TEST(IdentificationBatch, OurOwnFuzzyModelControlsBetterThanOurOwnLinearOne) {
  const Structure structure = structureOf();
  TsModel fuzzy = identify(makeDataSet(excite({}), structure, "simulated"), structure).model;
  TsModel linear = linearOf(fuzzy);
  fuzzy.name = "own fuzzy";
  linear.name = "own linear";
  const auto better = steadyRms(fuzzy), worse = steadyRms(linear);
  EXPECT_LE(better[0], 0.35 * worse[0]);
  EXPECT_LE(better[1], 0.70 * worse[1]);
}

// dT/dt = ac (Tw - T) over 10 s with Tw moving in between: held inputs give the published pair.
TEST(IdentificationBatch, TheCoreIsFoundWithinTheStatedDigits) {
  const Structure structure = structureOf();
  for (const int hold : {15, 1}) {
    const DataSet data = makeDataSet(excite({hold, false, 2}), structure, "simulated");
    const Rule rule = identify(data, structure).model.submodels[0].rules.front();
    std::printf("inputs held 1-%d: T(k+1) = %.6f Tw + %.6f T\n", hold, rule.coefficients[0],
                rule.coefficients[1]);
    const double tolerance = hold == 1 ? 3e-4 : 1e-4;
    EXPECT_NEAR(rule.coefficients[0], 0.0033, tolerance);
    EXPECT_NEAR(rule.coefficients[1], 0.9967, tolerance);
  }
}

TEST(IdentificationBatch, RulesThatTheDataDoNotDetermineAreRefusedOrBorrowedInTheirMode) {
  Structure structure = structureOf();
  const DataSet data = makeDataSet(excite({15, true, 3}), structure, "simulated");
  const Identification found = identify(data, structure);  // neighbour: none in the cold mode
  int borrowed = 0;
  for (const auto& rule : found.outputs[1].rules) borrowed += rule.status == RuleStatus::kBorrowed;
  EXPECT_EQ(borrowed, 5);
  EXPECT_EQ(found.remarks.size(), 5U);
  structure.consequents.scarce = ScarceRule::kError;
  EXPECT_THROW(identify(data, structure), InputError);
}

TEST(IdentificationBatch, ARuleWithoutSamplesTakesItsNeighbourOfTheSameModeAndSaysSo) {
  const Structure structure = structureOf();
  Matrix values = excite({15, false, 4});
  // what the hottest set saw in the hot mode is lost
  for (Eigen::Index k = 0; k < values.rows(); ++k)
    if (values(k, 1) > 60.0 && values(k, 4) == 1.0) values(k, 1) = std::nan("");
  Structure repaired = structure;
  repaired.repair.missing = MissingCells::kDrop;
  const DataSet data = makeDataSet(values, repaired, "simulated");
  const Identification found = identify(data, repaired);
  const auto& rules = found.outputs[1].rules;
  const auto& fitted = found.model.submodels[1].rules;
  ASSERT_EQ(rules.size(), 10U);
  std::size_t empty = 10;
  for (std::size_t i = 0; i < 10; ++i)
    if (rules[i].status == RuleStatus::kBorrowed) empty = i;
  ASSERT_EQ(empty, 9U);  // hot, 70 degC
  EXPECT_EQ(rules[9].lender, 8);
  EXPECT_EQ(fitted[9].coefficients, fitted[8].coefficients);
  EXPECT_NE(found.remarks.back().find("rule 9 stands in"), std::string::npos);
}

}  // namespace paper_identification_batch_test
}  // namespace fpc
