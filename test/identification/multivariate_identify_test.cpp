// Rules whose regions lie across the axes: found, recovered, learned online.
#include <gtest/gtest.h>

#include "config/model_file.hpp"
#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"
#include "identification/online_consequents.hpp"
#include "identification/partition.hpp"
#include "identification/prediction.hpp"

namespace fpc {
namespace fuzzy_multivariate_identify_test {

using Eigen::Vector2d;
using test::knownStructure;

const std::string kMultivariate = "partition: {membership: multivariate}\n";

/// Two regions side by side along the diagonal of (y, u): projected on y or on u they are the same.
TsModel tiltedModel() {
  TsModel model = test::knownModel();
  OutputModel& submodel = model.submodels[0];
  submodel.antecedents = submodel.regressors;
  const Matrix S = (Matrix(2, 2) << 8.0, -7.0, -7.0, 8.0).finished();
  for (std::size_t r = 0; r < 2; ++r) {
    const double side = r == 0 ? -0.4 : 0.4;
    submodel.rules[r].antecedents.clear();
    submodel.rules[r].multivariate = {Vector2d(side, -side), S};
  }
  submodel.rules[0].coefficients = Vector2d(0.3, 0.5);
  submodel.rules[1].coefficients = Vector2d(0.8, 0.1);
  return model;
}

/// A record (y, u) of a model with one output and one input, driven by random steps.
Matrix recordOf(const TsModel& model, Eigen::Index rows, std::uint64_t seed) {
  Matrix record = test::knownRecord(rows, seed);
  FiringResult firing;
  for (Eigen::Index k = 0; k + 1 < rows; ++k) {
    const Vector x = record.row(k).transpose();
    firingWeights(model.submodels[0], x, firing);
    record(k + 1, 0) = 0.0;
    for (std::size_t r = 0; r < model.submodels[0].rules.size(); ++r) {
      const Rule& rule = model.submodels[0].rules[r];
      record(k + 1, 0) +=
          firing.weights[static_cast<Eigen::Index>(r)] * (rule.coefficients.dot(x) + rule.offset);
    }
  }
  return record;
}

DataSet dataOf(const Matrix& record) { return makeDataSet(record, knownStructure(), "record"); }

/// Largest difference of the coefficients and offsets.
double difference(const TsModel& a, const TsModel& b) {
  double largest = 0.0;
  for (std::size_t r = 0; r < a.submodels[0].rules.size(); ++r) {
    const Rule &p = a.submodels[0].rules[r], &q = b.submodels[0].rules[r];
    largest = std::max({largest, (p.coefficients - q.coefficients).cwiseAbs().maxCoeff(),
                        std::abs(p.offset - q.offset)});
  }
  return largest;
}

TEST(MultivariateRules, AreTheAntecedentsBlockOfTheCovarianceInTheirOwnUnits) {
  Matrix F(3, 3);
  F << 1.0, 0.5, 0.3, 0.5, 1.0, 0.2, 0.3, 0.2, 1.0;
  Clusters clusters;
  clusters.centers = Eigen::Vector3d(0.5, -0.5, 9.0);
  clusters.covariances = {F};
  const ColumnScaling scaling{Eigen::Vector3d(1.0, 100.0, 0.0), Eigen::Vector3d(2.0, 10.0, 1.0)};
  const Matrix values = (Matrix(4, 2) << 0.0, 90.0, 1.0, 120.0, 3.0, 80.0, 0.0, 110.0).finished();
  PartitionParams params;
  params.width = 2.0;
  const auto rules = multivariateRules(values, clusters, scaling, params, 5);
  ASSERT_EQ(rules.size(), 1U);
  const MultivariateMembership& set = *rules[0].multivariate;
  EXPECT_EQ(set.center, Vector2d(2.0, 95.0));
  // Inverse of [1 .5; .5 1] is [4 -2; -2 4] / 3; then the units 2 and 10, then the width 2.
  EXPECT_NEAR(set.inverse_covariance(0, 0), 4.0 / 3.0 / 4.0 / 4.0, 1e-14);
  EXPECT_NEAR(set.inverse_covariance(0, 1), -2.0 / 3.0 / 20.0 / 4.0, 1e-15);
  EXPECT_NEAR(set.inverse_covariance(1, 1), 4.0 / 3.0 / 100.0 / 4.0, 1e-15);
  EXPECT_EQ(rules[0].coefficients, Vector::Zero(5));
}

TEST(MultivariateRules, OfCMeansHaveTheScatterOfTheirMembers) {
  Clusters clusters;
  clusters.fuzziness = 2.0;
  clusters.centers = Vector2d(0.0, 0.0);
  clusters.covariances = {Matrix::Identity(2, 2)};
  clusters.memberships = (Matrix(1, 5) << 1.0, 1.0, 0.5, 0.5, 0.0).finished();
  Matrix values(5, 2);
  values << 1.0, 1.0, -1.0, -1.0, 2.0, -2.0, -2.0, 2.0, 50.0, 7.0;
  PartitionParams params;
  params.method = PartitionMethod::kFuzzyCMeans;
  const auto rules =
      multivariateRules(values, clusters, {Vector::Zero(2), Vector::Ones(2)}, params, 1);
  // Scatter: 2 [1 1; 1 1] + 2 / 4 [4 -4; -4 4] = [4 0; 0 4]; weight 2.5.
  EXPECT_LT((rules[0].multivariate->inverse_covariance - 0.625 * Matrix::Identity(2, 2))
                .cwiseAbs()
                .maxCoeff(),
            1e-14);
}

TEST(MultivariateRules, GiveVariablesThatDoNotMoveNoWeightAndFlatClustersAWidth) {
  Clusters clusters;
  clusters.fuzziness = 2.0;
  clusters.centers = Eigen::Vector3d(0.0, 0.0, 3.0);
  clusters.memberships = Matrix::Ones(1, 3);
  Matrix values(3, 3);  // the second variable is the first, the third rests
  values << -1.0, -1.0, 3.0, 0.0, 0.0, 3.0, 1.0, 1.0, 3.0;
  PartitionParams params;
  params.method = PartitionMethod::kFuzzyCMeans;
  const auto rules =
      multivariateRules(values, clusters, {Vector::Zero(3), Vector::Ones(3)}, params, 1);
  const MultivariateMembership& set = *rules[0].multivariate;
  EXPECT_NO_THROW(set.validate("rule", 3));
  EXPECT_TRUE(set.inverse_covariance.row(2).isZero(0.0));
  EXPECT_NEAR(set.logDegree(Eigen::Vector3d(1.0, 1.0, 77.0)), -0.75, 1e-6);
  EXPECT_LT(set.logDegree(Eigen::Vector3d(1.0, -1.0, 3.0)), -1e5);
}

TEST(MultivariateIdentify, AKnownPartitionRecoversTheModel) {
  const TsModel truth = tiltedModel();
  const DataSet data = dataOf(recordOf(truth, 800, 1));
  const OutputModel& known = truth.submodels[0];
  const Regression rows = makeRegression(data, known.regressors, known.antecedents, 0);
  RuleFit fit;
  const OutputModel linear = fitLinear(rows, known.regressors, fit);
  ConsequentParams params;
  params.method = ConsequentMethod::kGlobal;
  params.ridge = 0.0;
  TsModel found = truth;
  for (auto& rule : found.submodels[0].rules) {
    rule.coefficients.setZero();
    rule.offset = 0.0;
  }
  fitConsequents(rows, linear, params, found.submodels[0]);
  EXPECT_LT(difference(found, truth), 1e-6);
}

TEST(MultivariateIdentify, RegionsAcrossTheAxesAreLostByProjectionAndKeptByEllipsoids) {
  const DataSet data = dataOf(recordOf(tiltedModel(), 1500, 1));
  const DataSet held_out = dataOf(recordOf(tiltedModel(), 500, 2));
  const auto rmse = [&](const TsModel& model) {
    return fitFigures(held_out.values.col(0), predictFreeRun(model, held_out).col(0)).rmse;
  };
  const auto structure = [](const std::string& membership) {
    return knownStructure("clusters: 2", "partition: {membership: " + membership + "}\n");
  };
  const auto projected = identify(data, structure("gaussian"));
  const auto found = identify(data, structure("multivariate"));
  EXPECT_LT(rmse(found.model), 0.8 * rmse(projected.model));
  EXPECT_LT(rmse(found.model), 0.5 * rmse(found.linear));
}

TEST(MultivariateIdentify, BothClusteringsBeatTheLinearModelAndSurviveTheirFile) {
  for (const char* method : {"gustafson_kessel", "fuzzy_c_means"}) {
    SCOPED_TRACE(method);
    const Structure structure = knownStructure(
        "antecedents: [y(k), u(k)]\n    clusters: [3, 4]",
        std::string("partition: {membership: multivariate, method: ") + method + "}\n");
    const DataSet data = dataOf(test::knownRecord(1500, 1, 0.01));
    const auto found = identify(data, structure);
    const DataSet held_out = dataOf(test::knownRecord(500, 2, 0.01));
    const auto rmse = [&](const TsModel& model) {
      return fitFigures(held_out.values.col(0), predictFreeRun(model, held_out).col(0)).rmse;
    };
    EXPECT_LT(rmse(found.model), 0.8 * rmse(found.linear));
    const std::string text = writeModel(found.model);
    EXPECT_EQ(writeModel(parseModel(text, "again")), text);
    EXPECT_EQ(writeModel(identify(data, structure).model), text);
    EXPECT_NE(found.model.source.find("multivariate sets"), std::string::npos);
  }
}

TEST(MultivariateIdentify, WeightsAreSharesOfOneFarOutsideTheData) {
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> exponent(-3.0, 300.0);
  const auto found = identify(dataOf(test::knownRecord(400, 4, 0.05)),
                              knownStructure("clusters: 5", kMultivariate));
  FiringResult firing;
  for (int i = 0; i < 500; ++i) {
    const double size = std::pow(10.0, exponent(generator));
    firingWeights(found.model.submodels[0], Vector2d(i % 2 ? size : -size, i % 3 ? size : -size),
                  firing);
    EXPECT_GE(firing.weights.minCoeff(), 0.0);
    EXPECT_NEAR(firing.weights.sum(), 1.0, 1e-12);
  }
}

TEST(MultivariateIdentify, AGridHasNoEllipsoids) {
  EXPECT_THROW(
      knownStructure(test::kKnownGrid, "partition: {method: grid, membership: multivariate}\n"),
      InputError);
}

TEST(MultivariateOnline, APerfectModelStaysAndAWrongOneLearns) {
  TsModel wrong = tiltedModel();
  wrong.submodels[0].rules[0].coefficients[1] = 0.2;
  RlsParams params;
  params.forgetting = 0.99;
  OnlineConsequents perfect(tiltedModel(), params), learning(wrong, params);
  const Matrix record = recordOf(tiltedModel(), 1000, 3);
  for (auto* online : {&perfect, &learning})
    for (Eigen::Index k = 0; k < record.rows(); ++k)
      online->take(record.row(k).head(1).transpose(),
                   Vector::Constant(1, k > 0 ? record(k - 1, 1) : 0.0), Vector(0));
  const auto error = [](const OnlineConsequents& online) {
    const DataSet fresh = dataOf(recordOf(tiltedModel(), 300, 4));
    return fitFigures(fresh.values.col(0), predictOneStep(online.model(), fresh).col(0)).rmse;
  };
  EXPECT_EQ(perfect.samples(), 999U);
  EXPECT_TRUE(perfect.model().submodels[0].rules[0].multivariate ==
              tiltedModel().submodels[0].rules[0].multivariate);
  OnlineConsequents untaught(wrong, params);
  EXPECT_LT(error(learning), 0.5 * error(untaught));
}

}  // namespace fuzzy_multivariate_identify_test
}  // namespace fpc
