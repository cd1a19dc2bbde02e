// Problems that need more than the dual method: semidefinite Hessians, linear programmes, rows that
// are zero up to rounding, duplicated rows, bad scales, contradictions. Answers by construction.
#include <cmath>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_semidefinite_test {

double costOf(const QpProblem& p, const Vector& x) { return 0.5 * x.dot(p.H * x) + p.g.dot(x); }

/// What errors of the cost are measured against: the sum of its terms.
double costSize(const QpProblem& p, const Vector& x) {
  return 1.0 + 0.5 * x.dot(p.H * x) + p.g.cwiseAbs().dot(x.cwiseAbs());
}

/// The problem of knownQp with a Hessian of that rank and the gradient that keeps x optimal.
KnownQp semidefiniteQp(Draw& draw, Eigen::Index n, Eigen::Index m, Eigen::Index rank) {
  KnownQp known = knownQp(draw, n, m);
  QpProblem& p = known.problem;
  const Matrix F = draw.matrix(n, rank);
  p.H.setZero();
  if (rank > 0) p.H.noalias() = F * F.transpose();
  p.H = (0.5 * (p.H + p.H.transpose())).eval();
  p.g = known.y_x + p.A.transpose() * known.y_a - p.H * known.x;
  return known;
}

/// Unknowns in units 10^-e to 10^e of the old, rows times 10^-e to 10^e.
void rescale(Draw& draw, KnownQp& known, double e) {
  QpProblem& p = known.problem;
  Vector s = draw.vector(p.g.size(), e), t = draw.vector(p.a_lower.size(), e);
  for (double& v : s) v = std::pow(10.0, v);
  for (double& v : t) v = std::pow(10.0, v);
  p.H = (s.asDiagonal() * p.H * s.asDiagonal()).eval();
  p.H = (0.5 * (p.H + p.H.transpose())).eval();
  p.A = (t.asDiagonal() * p.A * s.asDiagonal()).eval();
  p.a_lower = p.a_lower.cwiseProduct(t).eval();
  p.a_upper = p.a_upper.cwiseProduct(t).eval();
  for (Vector* v : {&p.x_lower, &p.x_upper, &known.x}) *v = v->cwiseQuotient(s).eval();
  known.y_x = known.y_x.cwiseProduct(s).eval();
  known.y_a = known.y_a.cwiseQuotient(t).eval();
  p.g = known.y_x + p.A.transpose() * known.y_a - p.H * known.x;
}

/// A minimum, though maybe not the one of the construction.
void expectOptimal(const KnownQp& known, QpSolver& solver, bool warm) {
  const QpProblem& p = known.problem;
  const QpResult& r = solver.solve(p, warm);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  ASSERT_LE(kktResidual(p, r.x, r.y_x, r.y_a), 1e-9);
  const double cost = costOf(p, known.x);
  ASSERT_NEAR(costOf(p, r.x), cost, 1e-8 * costSize(p, known.x));
}

TEST(QpSemidefinite, AnyRankGivesTheKnownCostColdAndWarm) {
  for (unsigned seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 50), m = draw.index(0, 60), rank = draw.index(0, n);
    const KnownQp known = semidefiniteQp(draw, n, m, rank);
    QpSolver solver(n, m);
    for (const bool warm : {false, true}) {
      expectOptimal(known, solver, warm);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(QpSemidefinite, BadlyScaledUnknownsAndRowsAreSolved) {
  for (unsigned seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 40), m = draw.index(0, 40);
    KnownQp known =
        draw.chance(0.5) ? knownQp(draw, n, m) : semidefiniteQp(draw, n, m, draw.index(0, n));
    rescale(draw, known, 3.0);
    QpSolver solver(n, m);
    expectOptimal(known, solver, false);
    if (HasFatalFailure()) return;
  }
}

/// A controller's problem with the states as unknowns and the model as equalities: x(i+1) = A x(i)
/// + B u(i), cost on the first state alone, inputs free inside bounds. n_x 3, n_u 2, unknowns x(1),
/// u(0), x(2), u(1), ...
QpProblem statesAsUnknowns(Draw& draw, Eigen::Index steps, const Matrix& A, const Matrix& B,
                           const Vector& start) {
  QpProblem p(5 * steps, 3 * steps);
  p.H.setZero();
  p.a_lower.setZero();
  p.a_lower.head(3) = A * start;
  p.a_upper = p.a_lower;
  for (Eigen::Index i = 0; i < steps; ++i) {
    p.H(5 * i, 5 * i) = 2.0;
    p.g(5 * i) = draw.uniform(-3.0, 3.0);
    p.A.block(3 * i, 5 * i, 3, 3).setIdentity();
    p.A.block(3 * i, 5 * i + 3, 3, 2) = -B;
    if (i > 0) p.A.block(3 * i, 5 * i - 5, 3, 3) = -A;
    p.x_lower.segment(5 * i + 3, 2).setConstant(-1.0);
    p.x_upper.segment(5 * i + 3, 2).setConstant(1.0);
  }
  return p;
}

/// The same with the states eliminated: only the inputs are left. @return the constant of the cost
double eliminateStates(const QpProblem& full, const Vector& start, const Matrix& A, const Matrix& B,
                       QpProblem& inputs) {
  const Eigen::Index steps = full.g.size() / 5;
  inputs = QpProblem(2 * steps, 0);
  inputs.H.setZero();
  inputs.x_lower.setConstant(-1.0);
  inputs.x_upper.setConstant(1.0);
  Matrix effect = Matrix::Zero(3, 2 * steps);
  Vector free = start;
  double constant = 0.0;
  for (Eigen::Index i = 0; i < steps; ++i) {
    effect = (A * effect).eval();
    effect.middleCols(2 * i, 2) = B;
    free = (A * free).eval();
    const Vector row = effect.row(0).transpose();
    inputs.H += 2.0 * row * row.transpose();
    inputs.g += row * (2.0 * free(0) + full.g(5 * i));
    constant += free(0) * (free(0) + full.g(5 * i));
  }
  return constant;
}

TEST(QpSemidefinite, StatesAsUnknownsAndStatesEliminatedCostTheSame) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index steps = draw.index(1, 20);
    Matrix A = draw.matrix(3, 3);
    A *= draw.uniform(0.3, 1.0) / A.lpNorm<1>();
    const Matrix B = draw.matrix(3, 2);
    const Vector start = draw.vector(3, 4.0);
    const QpProblem full = statesAsUnknowns(draw, steps, A, B, start);
    QpProblem inputs;
    const double constant = eliminateStates(full, start, A, B, inputs);
    QpSolver with_states(5 * steps, 3 * steps), without(2 * steps, 0);
    const QpResult& a = with_states.solve(full);
    const QpResult& b = without.solve(inputs);
    ASSERT_EQ(a.status, SolveStatus::kSolved);
    ASSERT_EQ(b.status, SolveStatus::kSolved);
    ASSERT_NEAR(costOf(full, a.x), costOf(inputs, b.x) + constant, 1e-9 * costSize(inputs, b.x));
  }
}

/// Rows that say nothing: all zero, or rounding of numbers of size one.
void addNoise(Draw& draw, QpProblem& p) {
  const Eigen::Index m = p.a_lower.size();
  const Matrix A = p.A;
  const Vector lower = p.a_lower, upper = p.a_upper;
  p.A.resize(2 * m, p.g.size());
  p.a_lower.resize(2 * m);
  p.a_upper.resize(2 * m);
  p.A << A, Matrix::Zero(m, p.g.size());
  p.a_lower << lower, Vector::Constant(m, -kInfinity);
  p.a_upper << upper, Vector::Constant(m, -2.8e-17);
  for (Eigen::Index i = m; i < 2 * m; ++i) {
    if (draw.chance(0.5)) p.A.row(i) = 1e-17 * draw.vector(p.g.size()).transpose();
    if (draw.chance(0.3)) p.a_lower(i) = p.a_upper(i);
  }
}

TEST(QpRows, RowsThatAreZeroUpToRoundingDoNotCount) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 40), m = draw.index(1, 40);
    KnownQp known =
        draw.chance(0.5) ? knownQp(draw, n, m) : semidefiniteQp(draw, n, m, draw.index(0, n));
    addNoise(draw, known.problem);
    QpSolver solver(n, 2 * m);
    for (const bool warm : {false, true}) {
      expectOptimal(known, solver, warm);
      if (HasFatalFailure()) return;
    }
  }
}

TEST(QpRows, TheZeroRowOfADeadTimeIsFeasible) {
  QpProblem p = nearestPointOfHalfPlane();
  p.A << 0.0, 0.0;
  p.a_lower << -kInfinity;
  p.a_upper << -2.8e-17;
  QpSolver solver(2, 1);
  const QpResult& r = solver.solve(p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  EXPECT_EQ(r.x.norm(), 0.0);
  EXPECT_EQ(kktResidual(p, r.x, r.y_x, r.y_a), 0.0);
  p.a_upper << -2.8e-12;  // no rounding
  ASSERT_EQ(solver.solve(p).status, SolveStatus::kInfeasible);
  EXPECT_TRUE(provesInfeasible(p, r.y_x, r.y_a, 100.0));
}

TEST(QpInfeasible, EveryContradictionComesWithItsProof) {
  for (unsigned seed = 1; seed <= 600; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 40), m = draw.index(2, 60);
    KnownQp known = semidefiniteQp(draw, n, m, draw.index(0, n));
    makeInfeasible(draw, known.problem, std::pow(10.0, draw.uniform(-6.0, 1.0)));
    if (draw.chance(0.5)) rescale(draw, known, 2.0);
    QpSolver solver(n, m);
    const QpResult& r = solver.solve(known.problem);
    ASSERT_EQ(r.status, SolveStatus::kInfeasible);
    ASSERT_TRUE(provesInfeasible(known.problem, r.y_x, r.y_a, 100.0));
    ASSERT_GE(farkasRadius(known.problem, r.y_x, r.y_a), 100.0);
  }
}

TEST(QpInfeasible, ProofsThatProveNothingHaveNoRadius) {
  QpProblem p = nearestPointOfHalfPlane();  // x_0 + x_1 >= 2
  p.x_upper << 0.5, 0.5;
  const Vector y_x = Vector::Constant(2, -1.0), y_a = Vector::Constant(1, 1.0);
  EXPECT_EQ(farkasRadius(p, Vector::Zero(2), Vector::Zero(1)), 0.0);
  EXPECT_EQ(farkasRadius(p, -y_x, y_a), 0.0);  // the multipliers of absent lower bounds
  EXPECT_GT(farkasRadius(p, y_x, y_a), 1e12);
  EXPECT_NEAR(farkasRadius(p, Eigen::Vector2d(-1.0, -0.9), y_a), 1.05 / 0.1, 1e-9);
  EXPECT_THROW(farkasRadius(p, y_x, y_x), InputError);
  p.x_upper << 1.0, 1.0;  // just feasible
  EXPECT_EQ(farkasRadius(p, y_x, y_a), 0.0);
}

}  // namespace optim_qp_semidefinite_test
}  // namespace fpc::testing
