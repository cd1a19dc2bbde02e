#include "identification/consequents.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "identification/identify_fixture.hpp"

namespace fpc {
namespace fuzzy_consequents_test {

struct Problem {
  Regression rows;
  OutputModel linear, model;
};

Problem problemOf(const Matrix& record) {
  const Structure structure = test::knownStructure();
  const DataSet data = makeDataSet(record, structure, "record");
  Problem p;
  p.model = test::knownModel().submodels.front();
  p.rows = makeRegression(data, p.model.regressors, p.model.antecedents, 0);
  RuleFit fit;
  p.linear = fitLinear(p.rows, p.model.regressors, fit);
  for (auto& rule : p.model.rules) rule.coefficients.setZero(), rule.offset = 0.0;
  return p;
}

void expectKnown(const OutputModel& model, double tolerance) {
  const OutputModel known = test::knownModel().submodels.front();
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_LT((model.rules[r].coefficients - known.rules[r].coefficients).cwiseAbs().maxCoeff(),
              tolerance)
        << r;
    EXPECT_NEAR(model.rules[r].offset, known.rules[r].offset, tolerance) << r;
  }
}

TEST(Consequents, GlobalLeastSquaresRecoversTheModelThatMadeTheData) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Problem p = problemOf(test::knownRecord(400, seed));
    ConsequentParams params;
    params.method = ConsequentMethod::kGlobal;
    params.ridge = 0.0;
    fitConsequents(p.rows, p.linear, params, p.model);
    expectKnown(p.model, 1e-9);
  }
}

TEST(Consequents, LocalAndRecursiveFitsRecoverRulesThatDoNotOverlap) {
  Problem p = problemOf(test::knownRecord(400, 3));
  // Crisp sets on either side of 0, data of crisp rules.
  OutputModel known = p.model;
  p.model.rules[0].antecedents[0] = {MembershipShape::kTrapezoidal, {-10.0, -10.0, 0.0, 0.0}};
  p.model.rules[1].antecedents[0] = {MembershipShape::kTrapezoidal, {0.0, 0.0, 10.0, 10.0}};
  const OutputModel truth = test::knownModel().submodels.front();
  for (Eigen::Index k = 0; k < p.rows.rows(); ++k) {
    const Rule& rule = truth.rules[p.rows.antecedents(k, 0) > 0.0 ? 1 : 0];
    p.rows.target[k] = rule.coefficients.dot(p.rows.regressors.row(k).transpose()) + rule.offset;
  }
  ConsequentParams params;
  params.ridge = 0.0;
  fitConsequents(p.rows, p.linear, params, p.model);
  expectKnown(p.model, 1e-9);
  params.method = ConsequentMethod::kRecursive;
  params.ridge = 1e-8;
  fitConsequents(p.rows, p.linear, params, p.model);
  expectKnown(p.model, 1e-6);
}

TEST(Consequents, TheRecursiveFitEqualsTheLocalOneOfTheSameRidge) {
  Problem p = problemOf(test::knownRecord(300, 5, 0.1));
  ConsequentParams params;
  params.ridge = 0.5;
  OutputModel local = p.model, recursive = p.model;
  fitConsequents(p.rows, p.linear, params, local);
  params.method = ConsequentMethod::kRecursive;
  fitConsequents(p.rows, p.linear, params, recursive);
  for (std::size_t r = 0; r < 2; ++r)
    EXPECT_LT((local.rules[r].coefficients - recursive.rules[r].coefficients).cwiseAbs().maxCoeff(),
              1e-8);
}

TEST(Consequents, AStrongRidgeGivesTheLinearModel) {
  Problem p = problemOf(test::knownRecord(300, 6, 0.1));
  ConsequentParams params;
  params.ridge = 1e12;
  for (const auto method : {ConsequentMethod::kLocal, ConsequentMethod::kGlobal}) {
    params.method = method;
    OutputModel model = p.model;
    fitConsequents(p.rows, p.linear, params, model);
    for (const auto& rule : model.rules)
      EXPECT_LT((rule.coefficients - p.linear.rules[0].coefficients).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(Consequents, ARuleWithoutDataIsBorrowedDroppedOrRefused) {
  Problem p = problemOf(test::knownRecord(300, 7, 0.1));
  Rule lonely = p.model.rules[0];
  lonely.antecedents[0] = {MembershipShape::kGaussian, {500.0, 0.7}};
  p.model.rules.push_back(lonely);
  ConsequentParams params;
  OutputModel borrowed = p.model;
  const auto fits = fitConsequents(p.rows, p.linear, params, borrowed);
  EXPECT_EQ(fits[2].status, RuleStatus::kBorrowed);
  EXPECT_NE(fits[2].remark.find("fewer than 9"), std::string::npos) << fits[2].remark;
  EXPECT_EQ(borrowed.rules[2].coefficients, p.linear.rules[0].coefficients);
  EXPECT_EQ(fits[0].status, RuleStatus::kFitted);
  params.scarce = ScarceRule::kDrop;
  OutputModel dropped = p.model;
  EXPECT_EQ(fitConsequents(p.rows, p.linear, params, dropped)[2].status, RuleStatus::kDropped);
  EXPECT_EQ(dropped.rules.size(), 2U);
  params.scarce = ScarceRule::kError;
  EXPECT_THROW(fitConsequents(p.rows, p.linear, params, p.model), InputError);
}

TEST(Consequents, ARuleWhoseDataAreFlatIsNeverGarbage) {
  Problem p = problemOf(test::knownRecord(300, 8, 0.1));
  p.rows.regressors.col(1) = 2.0 * p.rows.regressors.col(0);  // rank-deficient everywhere
  ConsequentParams params;
  params.ridge = 0.0;
  const auto fits = fitConsequents(p.rows, p.linear, params, p.model);
  for (std::size_t r = 0; r < 2; ++r) {
    EXPECT_EQ(fits[r].status, RuleStatus::kBorrowed);
    EXPECT_TRUE(std::isinf(fits[r].condition));
    EXPECT_TRUE(p.model.rules[r].coefficients.allFinite());
  }
}

TEST(Consequents, EvidenceAddsUpToTheSamples) {
  Problem p = problemOf(test::knownRecord(300, 9, 0.1));
  const auto fits = fitConsequents(p.rows, p.linear, {}, p.model);
  EXPECT_NEAR(fits[0].evidence + fits[1].evidence, 299.0, 1e-9);
  EXPECT_EQ(fits[0].samples + fits[1].samples, 299U);
  EXPECT_NEAR(static_cast<double>(p.model.rules[0].data_count), fits[0].evidence, 0.5);
}

}  // namespace fuzzy_consequents_test
}  // namespace fpc
