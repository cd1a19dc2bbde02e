// The stability table of the thesis (article 2, section 6.1) and the loop with past inputs as
// states.
#include "papers/paper_loop.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "fmbpc/base/input_error.hpp"
#include "model/undelayed.hpp"

namespace fpc {
namespace analysis_closed_loop_test {

const Matrix kA = (Matrix(2, 2) << 0.80, 0.77, 0.0, 0.88).finished();
const Matrix kB = (Matrix(2, 2) << 0.90, 0.57, 0.81, 0.0).finished();

struct TableRow {
  int horizon;
  double element, eigenvalue;
};
/// Six digits each; the thesis prints H = 6 without its sign.
const TableRow kTable[] = {
    {6, -0.868240, 0.775950}, {10, -3.643993, 0.833680}, {100, -51653.659497, 0.8799997}};

TEST(PaperReducedLoop, HasTheElementsAndEigenvaluesOfTheTable) {
  for (const auto& row : kTable) {
    const Matrix loop = paperReducedLoop(kA, kB, row.horizon);
    EXPECT_NEAR(loop(0, 1) / row.element, 1.0, 1e-6) << row.horizon;
    EXPECT_NEAR(loop(1, 1), row.eigenvalue, 5e-7) << row.horizon;
    EXPECT_NEAR(loop(1, 1), paperSecondEigenvalue(0.88, row.horizon), 1e-12);
    EXPECT_EQ(loop(1, 0), 0.0);
    EXPECT_NEAR(loop(0, 0), 0.0, 1e-12);
  }
  EXPECT_NEAR(paperReducedLoop(kA, kB, 1000)(1, 1), 0.88, 1e-12);
}

TEST(PaperReducedLoop, EqualsThePlainFormulaWhereThatCanBeSolved) {
  for (const int H : {1, 2, 6, 10}) {
    Matrix power = Matrix::Identity(2, 2), sum = Matrix::Zero(2, 2);
    for (int i = 0; i + 1 < H; ++i) {
      sum += power;
      power = power * kA;
    }
    Matrix hold(2, 2);
    hold << 1.0, 0.0, 1.0, 0.0;
    const Eigen::Matrix2d M = power * kB + sum * kB * hold;
    const Matrix expected = kA - kB * M.inverse() * power * kA;
    EXPECT_LT((paperReducedLoop(kA, kB, H) - expected).cwiseAbs().maxCoeff(), 1e-10) << H;
  }
}

TEST(PaperReducedLoop, RefusesMatricesOfAnotherShape) {
  EXPECT_THROW(paperReducedLoop(kB, kA, 6), InputError);
  EXPECT_THROW(paperReducedLoop(kA, kA, 6), InputError);
  EXPECT_THROW(paperReducedLoop(kA, kB, 0), InputError);
}

TEST(ClosedLoop, WithThePastInputAsAStateKeepsTheOpenLoopPoleOfTheSubstrate) {
  for (const int H : {1, 6, 10, 100, 1000}) {
    LoopLaw law;
    law.coincidence_steps = H;
    const ClosedLoop loop = closeLoop(paperModel(kA, kB), law);
    ASSERT_TRUE(loop.applicable);
    std::vector<double> values;
    for (const auto& value : loop.values) {
      EXPECT_EQ(value.imag(), 0.0);
      values.push_back(value.real());
    }
    std::sort(values.begin(), values.end());
    std::vector<double> expected{0.0, 0.8, paperSecondEigenvalue(0.88, H)};
    std::sort(expected.begin(), expected.end());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(values[i], expected[i], 1e-12) << H;
  }
}

TEST(ClosedLoop, IsNotApplicableWhileTheInputCannotReachTheOutput) {
  LinearModel late{AffineModel(3, 1, 1), Matrix::Zero(1, 3)};  // y(k+1) = 0.5 y(k) + u(k-2)
  late.affine.A << 0.5, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  late.affine.B << 0.0, 1.0, 0.0;
  late.affine.C << 1.0, 0.0, 0.0;
  late.previous_input(0, 1) = 1.0;
  LoopLaw law;
  for (law.coincidence_steps = 1; law.coincidence_steps < 3; ++law.coincidence_steps) {
    EXPECT_EQ(forcedGain(late, law.coincidence_steps), 0.0);
    EXPECT_FALSE(closeLoop(late, law).applicable);
  }
  EXPECT_EQ(forcedGain(late, 3), 1.0);
  EXPECT_TRUE(closeLoop(late, law).applicable);
}

/// y(k+1) = a y(k) + b y(k-1) + c u(k - delay)
TsModel delayedModel(double a, double b, double c, int delay) {
  TsModel model;
  model.name = "delayed";
  model.sample_time_s = 1.0;
  model.outputs = {{"y", "-", -1e3, 1e3}};
  model.inputs = {{"u", "-", -1e3, 1e3}};
  OutputModel submodel;
  submodel.antecedents = {{SignalKind::kOutput, 0, 0}};
  submodel.regressors = {
      {SignalKind::kOutput, 0, 0}, {SignalKind::kOutput, 0, 1}, {SignalKind::kInput, 0, delay}};
  Rule rule;
  rule.antecedents = {{MembershipShape::kGaussian, {0.0, 1.0}}};
  rule.coefficients = Eigen::Vector3d(a, b, c);
  submodel.rules = {rule};
  model.submodels = {submodel};
  return model;
}

TEST(ClosedLoop, OfTheDelayedModelIsThatOfTheUndelayedOneWithTheDelayAsZeroPoles) {
  const unsigned seed = 20260;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.2, 0.9);
  for (int trial = 0; trial < 50; ++trial) {
    const double p1 = part(random), p2 = part(random);
    const int delay = trial % 6, H = 2 + trial % 7;  // H = 1: all at 0
    const TsModel model = delayedModel(p1 + p2, -p1 * p2, part(random), delay);
    ASSERT_EQ(transportDelay(model), delay);
    LoopLaw late, prompt;
    late.coincidence_steps = H + delay;
    prompt.coincidence_steps = H;
    const ClosedLoop a = closeLoop(ruleModel(model, {0}, Vector()), late);
    const ClosedLoop b = closeLoop(ruleModel(withoutDelay(model, delay), {0}, Vector()), prompt);
    ASSERT_TRUE(a.applicable && b.applicable);
    EXPECT_NEAR(spectralRadius(a.values), spectralRadius(b.values), 1e-9) << trial;
    EXPECT_NEAR(a.A.trace(), b.A.trace(), 1e-12) << trial;
    EXPECT_NEAR((a.A * a.A).trace(), (b.A * b.A).trace(), 1e-12) << trial;
  }
}

TEST(ClosedLoop, WeightedWithoutMoveWeightIsThePublishedOneOfTheSameOutput) {
  LoopLaw published, weighted;
  weighted.published = false;
  weighted.weight_output = Eigen::Vector2d(0.0, 1.0);
  weighted.weight_move = Vector::Zero(1);
  const ClosedLoop a = closeLoop(paperModel(kA, kB), published);
  const ClosedLoop b = closeLoop(paperModel(kA, kB), weighted);
  EXPECT_LT((a.A - b.A).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(ClosedLoop, AHeavyMoveWeightMakesTheInputAlmostAnIntegrator) {
  LoopLaw law;
  law.published = false;
  law.weight_output = Eigen::Vector2d(0.0, 1.0);
  law.weight_move = Vector::Constant(1, 1e9);
  EXPECT_NEAR(spectralRadius(closeLoop(paperModel(kA, kB), law).values), 1.0, 1e-6);
  law.weight_move = Vector::Zero(2);
  EXPECT_THROW(closeLoop(paperModel(kA, kB), law), InputError);
}

TEST(RuleModels, ChoicesCombineTheRulesOfAllOutputs) {
  TsModel model = delayedModel(0.5, 0.0, 1.0, 0);
  model.submodels[0].rules.push_back(model.submodels[0].rules[0]);
  model.submodels[0].rules[1].coefficients[0] = 0.7;
  const auto choices = ruleChoices(model);
  ASSERT_EQ(choices.size(), 2U);
  EXPECT_EQ(text(choices[1]), "2");
  EXPECT_EQ(ruleModel(model, choices[1], Vector()).affine.A(0, 0), 0.7);
  EXPECT_THROW(ruleModel(model, {2}, Vector()), InputError);
  const LinearModel middle = blendedModel(model, Vector::Zero(1), Vector::Zero(1), Vector());
  EXPECT_NEAR(middle.affine.A(0, 0), 0.6, 1e-15);
}

}  // namespace analysis_closed_loop_test
}  // namespace fpc
