#include "identification/identify.hpp"
#include "config/structure_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_identify_test {

using test::knownRecord;
using test::knownStructure;

DataSet dataOf(const Matrix& record, const Structure& structure) {
  return makeDataSet(record, structure, "record");
}

double freeRunRmse(const TsModel& model, const DataSet& data) {
  return fitFigures(data.values.col(0), predictFreeRun(model, data).col(0)).rmse;
}

TEST(Identify, AKnownGridRecoversTheModelToTheLastDigits) {
  const Structure structure = knownStructure(
      test::kKnownGrid, "partition: {method: grid}\nconsequents: {method: global, ridge: 0}\n");
  const auto found = identify(dataOf(knownRecord(500, 1), structure), structure);
  const OutputModel known = test::knownModel().submodels.front();
  ASSERT_EQ(found.model.submodels[0].rules.size(), 2U);
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_LT((found.model.submodels[0].rules[r].coefficients - known.rules[r].coefficients)
                  .cwiseAbs()
                  .maxCoeff(),
              1e-6);
  EXPECT_TRUE(found.remarks.empty());
}

TEST(Identify, ClustersBeatTheLinearModelOnHeldOutData) {
  for (const char* method : {"gustafson_kessel", "fuzzy_c_means"})
    for (const char* membership : {"gaussian", "exponential"}) {
      SCOPED_TRACE(std::string(method) + " " + membership);
      const Structure structure = knownStructure(
          "antecedents: [u(k)]\n    clusters: 4",
          std::string("partition: {method: ") + method + ", membership: " + membership + "}\n");
      const auto found = identify(dataOf(knownRecord(1500, 1, 0.01), structure), structure);
      const DataSet held_out = dataOf(knownRecord(500, 2, 0.01), structure);
      EXPECT_LT(freeRunRmse(found.model, held_out), 0.8 * freeRunRmse(found.linear, held_out));
    }
}

/// Two outputs that wander on their own, moved by one input.
Matrix twoOutputRecord(Eigen::Index rows) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> level(-1.0, 1.0);
  Matrix values(rows, 3);
  double a = 0.0, b = 0.0;
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double u = level(generator);
    values.row(k) << a, b, u;
    const double before = a;
    a = 0.8 * a + 0.3 * std::sin(2.0 * b) + 0.2 * u;
    b = 0.7 * b - 0.2 * before * before + 0.4 * u;
  }
  return values;
}

TEST(Identify, WithoutTheOutputInTheClusterSpaceAllOutputsShareOnePartition) {
  const auto found = [](const std::string& with_output) {
    const Structure structure = parseStructure(
        "name: two\nsample_time_s: 1\noutputs: {a: {}, b: {}}\ninputs: {u: {}}\nsubmodels:\n"
        "  a: &both\n    regressors: [a(k), b(k), u(k)]\n    antecedents: [a(k), b(k)]\n"
        "    clusters: 4\n  b: *both\npartition: {method: fuzzy_c_means, with_output: " +
            with_output + "}\nconsequents: {method: recursive}\n",
        "two.yaml");
    return identify(dataOf(twoOutputRecord(600), structure), structure).model;
  };
  const auto antecedents = [](const TsModel& model, std::size_t output) {
    std::vector<std::vector<Membership>> sets;
    for (const Rule& rule : model.submodels[output].rules) sets.push_back(rule.antecedents);
    return sets;
  };
  const TsModel shared = found("false"), apart = found("true");
  EXPECT_EQ(antecedents(shared, 0), antecedents(shared, 1));
  EXPECT_NE(antecedents(apart, 0), antecedents(apart, 1));
}

TEST(Identify, SameSeedSameModel) {
  const Structure structure = knownStructure("clusters: auto");
  const DataSet data = dataOf(knownRecord(400, 3, 0.05), structure);
  EXPECT_EQ(writeModel(identify(data, structure).model),
            writeModel(identify(data, structure).model));
}

TEST(Identify, ItsModelSurvivesItsFile) {
  const Structure structure = knownStructure();
  const auto found = identify(dataOf(knownRecord(400, 4, 0.05), structure), structure);
  const std::string text = writeModel(found.model);
  EXPECT_EQ(writeModel(parseModel(text, "model")), text);
  EXPECT_NE(found.model.source.find("seed 1"), std::string::npos) << found.model.source;
}

TEST(Identify, WeightsAreSharesOfOneFarOutsideTheData) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> exponent(-3.0, 12.0);
  for (const char* membership : {"gaussian", "exponential"}) {
    const Structure structure =
        knownStructure("clusters: 5", std::string("partition: {membership: ") + membership + "}\n");
    const auto found = identify(dataOf(knownRecord(400, 4, 0.05), structure), structure);
    FiringResult firing;
    for (int i = 0; i < 500; ++i) {
      const double size = std::pow(10.0, exponent(generator));
      const Vector z = (Vector(2) << (i % 2 ? size : -size), (i % 3 ? size : -size)).finished();
      firingWeights(found.model.submodels[0], z, firing);
      EXPECT_GE(firing.weights.minCoeff(), 0.0);
      EXPECT_NEAR(firing.weights.sum(), 1.0, 1e-12);
    }
  }
}

TEST(Identify, TheNumberOfClustersIsChosenByFreeRunsOverHeldOutBlocks) {
  const Structure structure = knownStructure("antecedents: [u(k)]\n    clusters: [2, 5]");
  const auto found = identify(dataOf(knownRecord(1000, 5, 0.02), structure), structure);
  const auto& trials = found.outputs[0].trials;
  ASSERT_EQ(trials.size(), 4U);
  double lowest = 1e9;
  for (const auto& trial : trials) lowest = std::min(lowest, trial.score);
  const auto chosen = static_cast<int>(found.outputs[0].rules.size());
  for (const auto& trial : trials) {
    EXPECT_GE(trial.score, trial.free_run_rmse);
    EXPECT_GT(trial.free_run_rmse, 0.0);
    if (trial.clusters == chosen) {
      EXPECT_EQ(trial.score, lowest);
    }
  }
  EXPECT_GE(chosen, 2);
  EXPECT_LE(chosen, 5);
}

TEST(Identify, ProgressRisesToOneAndCancelStops) {
  const Structure structure = knownStructure();
  const DataSet data = dataOf(knownRecord(400, 6, 0.05), structure);
  double share = 0.0;
  identify(data, structure, [&](const IdentifyProgress& progress) {
    EXPECT_GE(progress.share, share);
    EXPECT_EQ(progress.output, "y");
    EXPECT_EQ(progress.samples, 399);
    share = progress.share;
    return true;
  });
  EXPECT_EQ(share, 1.0);
  int calls = 0;
  const auto found =
      identify(data, structure, [&](const IdentifyProgress&) { return ++calls < 3; });
  EXPECT_TRUE(found.cancelled);
  EXPECT_EQ(calls, 3);
}

TEST(Identify, AnInputThatNeverMovesIsDroppedWhenAllowed) {
  Matrix record = knownRecord(200, 7, 0.5);
  record.col(1).setConstant(1.0);
  const Structure structure = knownStructure("clusters: 2", "repair: {drop_constant: true}\n");
  const auto found = identify(dataOf(record, structure), structure);
  EXPECT_EQ(found.model.submodels[0].regressors.size(), 1U);
  EXPECT_NE(found.remarks.front().find("'u' never moves"), std::string::npos);
}

TEST(Identify, TooFewRowsAreRefused) {
  const Structure structure = knownStructure("clusters: 8");
  EXPECT_THROW(identify(dataOf(knownRecord(30, 8, 0.05), structure), structure), InputError);
}

TEST(Identify, AFreeRunFitLowersTheFreeRunErrorAndKeepsOneStepErrorsSmall) {
  // Noise on the measurement biases one-step least squares towards too fast a process.
  Matrix record = knownRecord(800, 9), fresh = knownRecord(800, 10);
  std::mt19937_64 generator(12);
  std::normal_distribution<double> normal(0.0, 0.3);
  for (double& y : record.col(0)) y += normal(generator);
  const std::string rules = "antecedents: [u(k)]\n    clusters: 2";
  const Structure plain = knownStructure(rules),
                  fitted = knownStructure(rules, "consequents: {free_run_iterations: 20}\n");
  const DataSet data = dataOf(record, plain), clean = dataOf(fresh, plain);
  const auto before = identify(data, plain), after = identify(data, fitted);
  EXPECT_LT(freeRunRmse(after.model, data), freeRunRmse(before.model, data));
  EXPECT_LT(freeRunRmse(after.model, clean), 0.7 * freeRunRmse(before.model, clean));
  EXPECT_NEAR(after.outputs[0].free_run.after, freeRunRmse(after.model, data), 1e-9);
  EXPECT_GT(after.outputs[0].free_run.iterations, 0);
}

}  // namespace fuzzy_identify_test
}  // namespace fpc
