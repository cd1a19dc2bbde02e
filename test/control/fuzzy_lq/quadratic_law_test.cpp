// The quadratic law against least squares on the simulated model, and the linear example of
// taieb2017 (eqs. 4-6, table 1), whose radii were computed independently.
#include "control/fuzzy_lq/quadratic_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <random>

#include "control/fuzzy_lq/linear_example.hpp"
#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace control_optimal_quadratic_law_test {

using Eigen::Index;

struct Case {
  AffineModel model;
  Vector x, previous, target, reference;
  QuadraticHorizon horizon;
  QuadraticWeights weights;
};

Case randomCase(std::mt19937_64& generator) {
  const auto upTo = [&](int n) { return std::uniform_int_distribution<int>(1, n)(generator); };
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto random = [&](Index rows, Index columns) {
    return Matrix::NullaryExpr(rows, columns, [&] { return unit(generator); }).eval();
  };
  const Index n_x = upTo(5), n_u = upTo(3), n_y = upTo(3);
  Case c;
  c.model = AffineModel(n_x, n_u, n_y);
  c.model.A = 0.6 * random(n_x, n_x);
  c.model.B = random(n_x, n_u);
  c.model.C = random(n_y, n_x);
  c.model.g = random(n_x, 1);
  c.horizon.prediction = upTo(8);
  c.horizon.moves = upTo(c.horizon.prediction);
  c.x = random(n_x, 1);
  c.previous = random(n_u, 1);
  c.target = random(n_u, 1);
  c.reference = random(n_y * c.horizon.prediction, 1);
  c.weights = {random(n_y, 1).cwiseAbs(), random(n_u, 1).cwiseAbs(), random(n_u, 1).cwiseAbs()};
  c.weights.move.array() += 0.01;
  return c;
}

/// Residuals whose squares are the cost of a sequence of inputs (n_u M), by stepping the model.
Vector residuals(const Case& c, const Vector& inputs) {
  const Index n_u = c.previous.size(), n_y = c.model.C.rows(), M = c.horizon.moves;
  Vector r(n_y * c.horizon.prediction + 2 * n_u * M);
  Vector x = c.x, before = c.previous;
  Index row = 0;
  for (Index j = 0; j < c.horizon.prediction; ++j) {
    const Vector u = inputs.segment(std::min(j, M - 1) * n_u, n_u);
    if (j < M) {
      r.segment(row, n_u) = (c.weights.move.cwiseSqrt().array() * (u - before).array()).matrix();
      row += n_u;
      r.segment(row, n_u) = (c.weights.input.cwiseSqrt().array() * (u - c.target).array()).matrix();
      row += n_u;
      before = u;
    }
    x = (c.model.A * x + c.model.B * u + c.model.g).eval();
    const Vector e = c.model.C * x - c.reference.segment(j * n_y, n_y);
    r.segment(row, n_y) = (c.weights.output.cwiseSqrt().array() * e.array()).matrix();
    row += n_y;
  }
  return r;
}

Vector lawInput(const QuadraticLaw& law, const Case& c) {
  return law.reference * c.reference - law.K * c.x - law.offset * c.model.g +
         law.previous * c.previous + law.target * c.target;
}

TEST(QuadraticLaw, FirstInputIsThatOfLeastSquaresOnTheSteppedModel) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 generator(seed);
    const Case c = randomCase(generator);
    const Index n = c.previous.size() * c.horizon.moves;
    const Vector at_zero = residuals(c, Vector::Zero(n));
    Matrix slope(at_zero.size(), n);
    for (Index j = 0; j < n; ++j) slope.col(j) = residuals(c, Vector::Unit(n, j)) - at_zero;
    const Vector best = slope.colPivHouseholderQr().solve(-at_zero);
    const QuadraticLaw law = makeQuadraticLaw(c.model, c.horizon, c.weights);
    ASSERT_TRUE(law.usable) << "seed " << seed;
    const double error = (lawInput(law, c) - best.head(c.previous.size())).norm();
    EXPECT_LT(error, 1e-9 * (1.0 + best.norm())) << "seed " << seed;
  }
}

TEST(QuadraticLaw, LinearExampleHasNoGradientLeft) {
  const AffineModel model = test::linearExample();
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> unit(-20.0, 20.0);
  for (const QuadraticWeights& weights : test::tableOne()) {
    const QuadraticLaw law = makeQuadraticLaw(model, {}, weights);
    for (int i = 0; i < 100; ++i) {
      const Vector x = Vector::NullaryExpr(4, [&] { return unit(generator); });
      const Vector u =
          law.reference * test::linearSetpoint() - law.K * x + law.target * Vector::Ones(2);
      const Matrix G = model.C * model.B;
      const Vector error = model.C * (model.A * x + model.B * u) - test::linearSetpoint();
      const Vector gradient = 2.0 * (G.transpose() * weights.output.asDiagonal() * error +
                                     weights.input.asDiagonal() * (u - Vector::Ones(2)));
      EXPECT_LE(gradient.norm(), 1e-9);
    }
  }
}

/// Of the loop in (x(k), u(k-1)).
double spectralRadius(const QuadraticLaw& law) {
  const AffineModel m = test::linearExample();
  Matrix loop(6, 6);
  loop << m.A - m.B * law.K, m.B * law.previous, -law.K, law.previous;
  return loop.eigenvalues().cwiseAbs().maxCoeff();
}

TEST(QuadraticLaw, LinearExampleIsStableWhenItsInputsAreFoundTogetherOnly) {
  const auto columns = test::tableOne();
  const AffineModel model = test::linearExample();
  EXPECT_NEAR(spectralRadius(makeQuadraticLaw(model, {1, 1, true}, columns[0])), 0.9558, 1e-3);
  const double each[] = {1.1778, 1.9058, 1.2499, 0.9541};
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(spectralRadius(makeQuadraticLaw(model, {1, 1, false}, columns[i])), each[i], 1e-3)
        << "column " << i + 1;
}

TEST(QuadraticLaw, LinearExampleOvershootsAsComputedIndependently) {
  const test::LinearRun run = test::runLinearExample(test::tableOne()[0], Vector::Ones(2), 400);
  EXPECT_NEAR(run.overshoot_percent[0], 23.57, 0.005);
  EXPECT_NEAR(run.overshoot_percent[1], 0.43, 0.005);
}

TEST(QuadraticLaw, LinearExampleMissesItsSetpointUnlessTheTargetIsTheSteadyInput) {
  const AffineModel m = test::linearExample();
  const Matrix gain = m.C * (Matrix::Identity(4, 4) - m.A).lu().solve(m.B);
  const Vector steady = gain.lu().solve(test::linearSetpoint());
  EXPECT_NEAR(steady[0], 1.0006, 5e-5);
  EXPECT_NEAR(steady[1], 0.99975, 5e-6);
  const auto offset = [](const Vector& target) {
    return test::runLinearExample(test::tableOne()[0], target, 3000).error.cwiseAbs().maxCoeff();
  };
  EXPECT_LT(offset(steady), 1e-9);
  EXPECT_LE(offset(Vector::Ones(2)), 0.0025);
  EXPECT_GT(offset(Vector::Ones(2)), 1e-4);
  EXPECT_GT(offset(Vector::Zero(2)), 0.1);
}

TEST(QuadraticLaw, MoveWeightIsTheTargetAtTheLastInput) {
  std::mt19937_64 generator(11);
  Case c = randomCase(generator);
  c.horizon = {1, 1, true};
  c.reference = c.reference.head(c.model.C.rows()).eval();
  c.weights.input.setZero();
  const Vector by_move = lawInput(makeQuadraticLaw(c.model, c.horizon, c.weights), c);
  std::swap(c.weights.input, c.weights.move);
  c.target = c.previous;
  EXPECT_LT((lawInput(makeQuadraticLaw(c.model, c.horizon, c.weights), c) - by_move).norm(), 1e-12);
}

/// y(k+1) = 0.9 y + b1 u(k) + u(k-1); states y, u(k-1).
AffineModel lateInput(double b1) {
  AffineModel m(2, 1, 1);
  m.A << 0.9, 1.0, 0.0, 0.0;
  m.B << b1, 1.0;
  m.C << 1.0, 0.0;
  return m;
}

TEST(QuadraticLaw, AHorizonBeforeTheInputActsIsUnusableOrShortSighted) {
  const Vector one = Vector::Ones(1), none = Vector::Zero(1);
  const QuadraticWeights free{one, none, none}, calm{one, one, none};
  EXPECT_FALSE(makeQuadraticLaw(lateInput(0.0), {1, 1, true}, free).usable);
  EXPECT_TRUE(makeQuadraticLaw(lateInput(0.0), {1, 1, true}, calm).short_sighted);
  EXPECT_TRUE(makeQuadraticLaw(lateInput(0.01), {1, 1, true}, free).short_sighted);
  const QuadraticLaw two = makeQuadraticLaw(lateInput(0.0), {2, 1, true}, free);
  EXPECT_TRUE(two.usable);
  EXPECT_FALSE(two.short_sighted);
}

TEST(QuadraticLaw, RefusesWhatCannotBeMeant) {
  const Vector one = Vector::Ones(1), none = Vector::Zero(1);
  const AffineModel m = lateInput(1.0);
  EXPECT_THROW(makeQuadraticLaw(m, {0, 1, true}, {one, none, none}), InputError);
  EXPECT_THROW(makeQuadraticLaw(m, {2, 3, true}, {one, none, none}), InputError);
  EXPECT_THROW(makeQuadraticLaw(m, {2, 1, true}, {none, none, none}), InputError);
  EXPECT_THROW(makeQuadraticLaw(m, {2, 1, true}, {one, -one, none}), InputError);
  EXPECT_THROW(makeQuadraticLaw(m, {2, 1, true}, {one, none, Vector::Ones(2)}), InputError);
}

}  // namespace control_optimal_quadratic_law_test
}  // namespace fpc
