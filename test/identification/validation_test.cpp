#include "identification/validation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"

namespace fpc {
namespace fuzzy_validation_test {

/// y(k+1) = a y(k) + b u(k) + c
TsModel linearModel(double a, double b, double c) {
  TsModel model = test::knownModel();
  Rule rule;
  rule.coefficients = (Vector(2) << a, b).finished();
  rule.offset = c;
  model.submodels[0].antecedents.clear();
  model.submodels[0].rules = {rule};
  return model;
}

DataSet dataOf(const Matrix& record, const std::string& settings = "") {
  return makeDataSet(record, test::knownStructure("clusters: 1", settings), "record");
}

TEST(FitFigures, AreWhatTheyAreOnPaper) {
  // y = 1, 2, 3, 4; p = y + 1: error constant, so VAF 100; RMSE 1; |y - mean| = sqrt(5), |e| = 2.
  const Vector y = (Vector(5) << 1.0, 2.0, 3.0, 4.0, kNaN).finished();
  const FitFigures f = fitFigures(y, (y.array() + 1.0).matrix());
  EXPECT_EQ(f.samples, 4);
  EXPECT_NEAR(f.rmse, 1.0, 1e-15);
  EXPECT_NEAR(f.mse, 1.0, 1e-15);
  EXPECT_NEAR(f.vaf, 100.0, 1e-12);
  EXPECT_NEAR(f.fit, 100.0 * (1.0 - 2.0 / std::sqrt(5.0)), 1e-12);
}

TEST(Prediction, OneStepUsesMeasurementsAndFreeRunItsOwnPast) {
  Matrix record(12, 2);
  for (Eigen::Index k = 0; k < 12; ++k)
    record.row(k) << std::cos(static_cast<double>(k)), static_cast<double>(k % 3);
  const DataSet data = dataOf(record);
  const TsModel model = linearModel(0.5, 2.0, 1.0);
  const Matrix one_step = predictOneStep(model, data), free_run = predictFreeRun(model, data);
  EXPECT_TRUE(std::isnan(one_step(0, 0)));
  EXPECT_TRUE(std::isnan(free_run(0, 0)));
  double y = record(0, 0);
  for (Eigen::Index k = 0; k < 11; ++k) {
    EXPECT_NEAR(one_step(k + 1, 0), 0.5 * record(k, 0) + 2.0 * record(k, 1) + 1.0, 1e-14);
    y = 0.5 * y + 2.0 * record(k, 1) + 1.0;
    EXPECT_NEAR(free_run(k + 1, 0), y, 1e-14);
  }
}

TEST(Prediction, FreeRunsStartAgainAfterAGapInTheInputs) {
  Matrix record = test::knownRecord(40, 1);
  record(20, 1) = kNaN;
  const DataSet data = dataOf(record, "repair: {missing: drop}\n");
  const Matrix free_run = predictFreeRun(linearModel(0.0, 0.0, 7.0), data);
  EXPECT_EQ(free_run(20, 0), 7.0);
  EXPECT_TRUE(std::isnan(free_run(21, 0)));
  EXPECT_EQ(free_run(22, 0), 7.0);
}

TEST(Prediction, ARunawayStaysFinite) {
  const DataSet data = dataOf(test::knownRecord(500, 2));
  const Matrix free_run = predictFreeRun(linearModel(3.0, 1.0, 0.0), data);
  EXPECT_TRUE(free_run.bottomRows(499).allFinite());
  EXPECT_LT(fitFigures(data.values.col(0), free_run.col(0)).vaf, -1000.0);
}

TEST(Prediction, OtherSignalsAreRefused) {
  TsModel model = linearModel(0.5, 1.0, 0.0);
  model.inputs[0].name = "v";
  EXPECT_THROW(predictOneStep(model, dataOf(test::knownRecord(40, 3))), InputError);
}

TEST(Validation, ThePerfectModelIsPerfectAndStandsBesideTheLinearOne) {
  const DataSet data = dataOf(test::knownRecord(300, 4));
  const auto result = validateModel(test::knownModel(), linearModel(0.7, 0.35, 0.0), data);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_NEAR(result[0].free_run.fit, 100.0, 1e-9);
  EXPECT_NEAR(result[0].one_step.vaf, 100.0, 1e-9);
  EXPECT_LT(result[0].linear_free_run.fit, 99.0);
  EXPECT_EQ(result[0].one_step.samples, 299);
}

TEST(Validation, WhiteResidualsStayInsideTheirBoundsAndColouredOnesDoNot) {
  const DataSet data = dataOf(test::knownRecord(4000, 5));
  std::mt19937_64 generator(6);
  std::normal_distribution<double> normal;
  Vector white(4000), coloured(4000);
  for (Eigen::Index k = 0; k < 4000; ++k) {
    white[k] = normal(generator);
    coloured[k] = (k > 0 ? 0.8 * coloured[k - 1] : 0.0) + white[k];
  }
  ValidationParams params;
  const auto good = residualCorrelation(data, white, params),
             bad = residualCorrelation(data, coloured, params);
  EXPECT_NEAR(good.bound, 2.5758293 / std::sqrt(4000.0), 1e-7);
  for (const auto& [confidence, quantile] : {std::pair{0.5001, 0.6746471},
                                             {0.55, 0.7554150},
                                             {0.61, 0.8596174},
                                             {0.95, 1.9599640},
                                             {0.999999, 4.8916385}}) {
    params.confidence = confidence;
    EXPECT_NEAR(residualCorrelation(data, white, params).bound * std::sqrt(4000.0), quantile, 2e-6)
        << confidence;
  }
  EXPECT_LT(good.outside, 0.1);
  EXPECT_NEAR(bad.autocorrelation[0], 0.8, 0.05);
  EXPECT_GT(bad.outside, 0.1);
}

TEST(Validation, AForgottenInputShowsInTheCrossCorrelation) {
  const DataSet data = dataOf(test::knownRecord(2000, 7));
  Vector residual = Vector::Zero(2000);
  for (Eigen::Index k = 3; k < 2000; ++k) residual[k] = data.values(k - 3, 1);
  const auto result = residualCorrelation(data, residual, {});
  EXPECT_EQ(result.signals, std::vector<std::string>{"u"});
  Eigen::Index at = -1;
  result.cross.row(0).maxCoeff(&at);
  EXPECT_EQ(at, 2);  // u(k - 3) is the cause at lag 2 before the newest, u(k - 1)
  EXPECT_NEAR(result.cross(0, 2), 1.0, 0.01);
}

TEST(Validation, PolesAndGainsOfARuleAreKnown) {
  TsModel model = linearModel(0.5, 2.0, 1.0);
  model.submodels[0].regressors = {{SignalKind::kOutput, 0, 0},
                                   {SignalKind::kOutput, 0, 1},
                                   {SignalKind::kInput, 0, 0},
                                   {SignalKind::kInput, 0, 1}};
  model.submodels[0].rules[0].coefficients = (Vector(4) << 1.1, -0.3, 0.5, 0.1).finished();
  const auto dynamics = ruleDynamics(model);
  ASSERT_EQ(dynamics.size(), 1U);
  ASSERT_EQ(dynamics[0].poles.size(), 2U);
  EXPECT_NEAR(dynamics[0].poles[0].real(), 0.6, 1e-12);
  EXPECT_NEAR(dynamics[0].poles[1].real(), 0.5, 1e-12);
  EXPECT_EQ(dynamics[0].signals, std::vector<std::string>{"u"});
  EXPECT_NEAR(dynamics[0].gains[0], 0.6 / 0.2, 1e-12);
}

TEST(Validation, CorrelationsOfDriftsStayWithinOne) {
  const DataSet data = dataOf(test::knownRecord(50, 4));
  DataSet ramp = data;
  ramp.values.col(1) = Vector::LinSpaced(50, 0.0, 1.0);
  const Vector residual = Vector::LinSpaced(50, 3.0, 9.0).array().square();
  const ResidualCorrelation c = residualCorrelation(ramp, residual, {});
  EXPECT_LE(c.cross.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_GT(c.cross(0, 0), 0.9);
  EXPECT_LE(c.autocorrelation.cwiseAbs().maxCoeff(), 1.0);
}

}  // namespace fuzzy_validation_test
}  // namespace fpc
