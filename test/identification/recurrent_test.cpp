// Recursions with parameters: derivatives, fits to free runs, starts of hidden states.
#include "identification/recurrent_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"

namespace fpc {
namespace fuzzy_recurrent_test {

using Eigen::Index;

RecurrentShape shapeOf(bool companion, Index states, Index rules) {
  RecurrentShape s;
  s.companion = companion;
  s.states = states;
  s.exogenous = 2;
  for (Index i = 0; i < states + 2; ++i) s.regressors.push_back(i);
  s.rules = rules;
  if (rules > 1) s.antecedents = {0, states};
  return s;
}

Vector randomVector(Index n, double size, std::mt19937_64& random) {
  Vector v(n);
  for (double& x : v) x = size * standardNormal(random);
  return v;
}

/// Two rules on y: slow below zero, fast above.
Vector twoSpeeds(const RecurrentShape& s) {
  Vector p = Vector::Zero(s.parameterCount());
  p.segment(s.at(0, 0), 3) << 0.9, 0.1, 0.0;
  p.segment(s.at(1, 0), 3) << 0.6, 0.4, 0.1;
  p[s.centre(0)] = -0.5;
  p[s.centre(1)] = 0.5;
  p[s.logWidth(0)] = p[s.logWidth(1)] = std::log(0.4);
  return p;
}

RecurrentShape oneInput(Index rules) {
  RecurrentShape s;
  s.exogenous = 1;
  s.regressors = {0, 1};
  s.rules = rules;
  if (rules > 1) s.antecedents = {0};
  return s;
}

RecurrentData simulate(const RecurrentShape& s, const Vector& p, Index rows, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  RecurrentData data;
  data.y = Vector::Zero(rows);
  data.v.resize(s.exogenous, rows);
  double level = 0.0;
  for (Index k = 0; k < rows; ++k) {
    if (k % 7 == 0) level = 2.0 * uniform(random) - 1.0;
    data.v.col(k).setConstant(level);
  }
  RecurrentStep step(s);
  Vector x = Vector::Zero(s.states), next(s.states);
  for (Index k = 0; k < rows; ++k) {
    data.y[k] = s.output(x[0]);
    step.predict(p, x, data.v.col(k), next);
    x = next;
  }
  return data;
}

class Derivatives : public testing::TestWithParam<std::tuple<bool, int, int>> {};

TEST_P(Derivatives, EqualDifferences) {
  const auto [companion, states, rules] = GetParam();
  const RecurrentShape s = shapeOf(companion, states, rules);
  std::mt19937_64 random(5);
  const Vector p = randomVector(s.parameterCount(), 0.4, random);
  const Vector x = randomVector(states, 1.0, random), v = randomVector(2, 1.0, random);
  const Index n_p = s.parameterCount();
  RecurrentStep step(s);
  Vector next(states), above(states), below(states);
  step.predict(p, x, v, next);
  Matrix sensitivity = Matrix::Zero(states, n_p + states);
  sensitivity.rightCols(states).setIdentity();  // d x / d x0
  step.differentiate(p, sensitivity);
  const double nudge = 1e-6;
  for (Index i = 0; i < n_p + states; ++i) {
    Vector q = p, z = x;
    (i < n_p ? q[i] : z[i - n_p]) += nudge;
    step.predict(q, z, v, above);
    (i < n_p ? q[i] : z[i - n_p]) -= 2.0 * nudge;
    step.predict(q, z, v, below);
    const Vector slope = (above - below) / (2.0 * nudge);
    EXPECT_LT((slope - sensitivity.col(i)).cwiseAbs().maxCoeff(), 1e-7) << "column " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, Derivatives,
                         testing::Values(std::tuple{true, 1, 1}, std::tuple{true, 3, 1},
                                         std::tuple{true, 2, 3}, std::tuple{false, 2, 1},
                                         std::tuple{false, 3, 2}));

TEST(RecurrentFit, FindsTheSystemThatMadeTheFreeRun) {
  const RecurrentShape s = oneInput(2);
  const Vector truth = twoSpeeds(s);
  const RecurrentData data = simulate(s, truth, 400, 3);
  Vector start = truth;
  start.head(s.linearCount()) += Vector::Constant(s.linearCount(), 0.05);
  RecurrentFitParams params;
  params.ridge = 0.0;
  params.set_ridge = 1e6;  // the sets are known: what they share with the consequents is a valley
  params.settle = 1e-12;
  params.iterations = 100;
  const auto fit = fitRecurrent(s, data, {{0, 400}}, start, start, params);
  ASSERT_TRUE(fit.finite);
  EXPECT_LT(fit.objective, 1e-12);
}

TEST(RecurrentFit, NeverEndsWorseThanItBegan) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const RecurrentShape s = oneInput(2);
    std::mt19937_64 random(seed);
    RecurrentData data = simulate(s, twoSpeeds(s), 200, seed);
    data.y += randomVector(200, 0.2, random);
    const Vector start = twoSpeeds(s) + randomVector(s.parameterCount(), 0.1, random);
    RecurrentFitParams params;
    params.iterations = 0;
    const double before = fitRecurrent(s, data, {{0, 200}}, start, start, params).objective;
    params.iterations = 20;
    EXPECT_LT(fitRecurrent(s, data, {{0, 200}}, start, start, params).objective, before);
  }
}

TEST(RecurrentFit, ASensorAtItsLimitHidesNothingFromTheFit) {
  RecurrentShape s = oneInput(1);
  Vector truth(3);
  truth << 0.8, 0.4, 0.1;
  s.lower = -100.0;
  s.upper = 0.8;
  const RecurrentData clipped = simulate(s, truth, 300, 9);
  ASSERT_GT((clipped.y.array() == 0.8).count(), 20);
  RecurrentFitParams params;
  params.ridge = 0.0;
  params.settle = 1e-12;
  const Vector start = 0.9 * truth;
  const auto aware = fitRecurrent(s, clipped, {{0, 300}}, start, start, params);
  s.upper = s.lower;
  const auto unaware = fitRecurrent(s, clipped, {{0, 300}}, start, start, params);
  EXPECT_LT((aware.parameters - truth).norm(), 1e-6);
  EXPECT_GT((unaware.parameters - truth).norm(), 1e-2);
}

TEST(RecurrentFit, GapsAreStartsNotErrors) {
  const RecurrentShape s = oneInput(1);
  Vector truth(3);
  truth << 0.9, 0.2, 0.0;
  RecurrentData data = simulate(s, truth, 200, 4);
  data.v.col(80).setConstant(std::nan(""));
  data.y[120] = std::nan("");
  RecurrentFitParams params;
  params.ridge = 0.0;
  const auto fit = fitRecurrent(s, data, {{0, 200}}, truth, truth, params);
  ASSERT_TRUE(fit.finite);
  EXPECT_LT(fit.objective, 1e-20);
}

TEST(RecurrentRun, AHiddenStateIsFoundFromTheFirstSamples) {
  RecurrentShape s;
  s.companion = false;
  s.states = 2;
  s.exogenous = 1;
  s.regressors = {0, 1, 2};
  Vector p(8);
  p << 0.9, 0.1, 0.0, 0.0, 0.0, 0.7, 0.3, 0.0;  // a chain of two lags
  RecurrentData data = simulate(s, p, 100, 6);
  StartPrior prior{Vector::Zero(2), Matrix::Identity(2, 2), 1e-4, {}, {}};
  const Vector run = runRecurrent(s, data, {40, 100}, p, prior, 5);
  EXPECT_LT((run.tail(50) - data.y.tail(50)).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_TRUE(std::isnan(run[39]));
  s.absolute = true;  // the sign is hidden as well
  data = simulate(s, p, 100, 6);
  const Vector size = runRecurrent(s, data, {40, 100}, p, prior, 5);
  EXPECT_LT((size.tail(50) - data.y.tail(50)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(RecurrentRun, StatesAreHeldInsideTheirLimits) {
  RecurrentShape s;
  s.companion = false;
  s.exogenous = 1;
  s.regressors = {0, 1};
  Vector p(3);
  p << 1.2, 0.0, 0.0;
  RecurrentData data;
  data.y = Vector::Ones(60);
  data.v = Matrix::Zero(1, 60);
  StartPrior prior{Vector::Ones(1), Matrix::Identity(1, 1), 0.1, Vector::Constant(1, -2.0),
                   Vector::Constant(1, 2.0)};
  EXPECT_EQ(runRecurrent(s, data, {0, 60}, p, prior, 1).maxCoeff(), 2.0);
}

}  // namespace fuzzy_recurrent_test
}  // namespace fpc
