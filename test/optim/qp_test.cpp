// Small quadratic programmes whose primal and dual answers are known on paper, cold and warm.
#include "optim/qp.hpp"

#include <initializer_list>
#include <utility>

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_test {

void expectVector(const Vector& actual, std::initializer_list<double> expected) {
  ASSERT_EQ(actual.size(), static_cast<Eigen::Index>(expected.size()));
  Eigen::Index i = 0;
  for (const double value : expected) EXPECT_NEAR(actual(i++), value, 1e-14) << "entry " << i - 1;
}

const QpResult& solveOnce(QpSolver& solver, const QpProblem& p) { return solver.solve(p, false); }

TEST(Qp, WithoutConstraintsTheGradientVanishes) {
  QpProblem p(2, 0);  // 2 x_1 = 2, 4 x_2 = 8
  p.H << 2.0, 0.0, 0.0, 4.0;
  p.g << -2.0, -8.0;
  QpSolver solver(2, 0);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 2.0});
  expectVector(r.y_x, {0.0, 0.0});
  EXPECT_EQ(r.active, 0);
  EXPECT_EQ(r.iterations, 1);
  EXPECT_LE(r.kkt_residual, 1e-15);
}

TEST(Qp, ActiveUpperBoundHasNegativeMultiplierAndIsMetExactly) {
  QpProblem p(1, 0);  // x - 3 at x = 0.3
  p.g << -3.0;
  p.x_upper << 0.3;
  QpSolver solver(1, 0);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  EXPECT_EQ(r.x(0), 0.3);
  expectVector(r.y_x, {-2.7});
  EXPECT_EQ(r.active, 1);
}

TEST(Qp, ActiveLowerBoundHasPositiveMultiplier) {
  QpProblem p(2, 0);  // x_1 = 1: 2 x_2 + x_1 = 0, y = 2 x_1 + x_2
  p.H << 2.0, 1.0, 1.0, 2.0;
  p.x_lower(0) = 1.0;
  QpSolver solver(2, 0);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, -0.5});
  expectVector(r.y_x, {1.5, 0.0});
}

TEST(Qp, LowerRowHasPositiveMultiplier) {
  QpSolver solver(2, 1);
  const QpResult& r = solveOnce(solver, nearestPointOfHalfPlane());
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 1.0});
  expectVector(r.y_a, {1.0});
  expectVector(r.y_x, {0.0, 0.0});
}

TEST(Qp, UpperSideOfTwoSidedRowHasNegativeMultiplier) {
  QpProblem p(2, 1);  // on x_1 - x_2 = 1: 2 x_1 - 5 = 0
  p.g << -4.0, 0.0;
  p.x_lower << 0.0, 0.0;
  p.x_upper << 5.0, 5.0;
  p.A << 1.0, -1.0;
  p.a_lower << -1.0;
  p.a_upper << 1.0;
  QpSolver solver(2, 1);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {2.5, 1.5});
  expectVector(r.y_a, {-1.5});
  expectVector(r.y_x, {0.0, 0.0});
}

TEST(Qp, BoundsThatEnterFirstLeaveAgain) {
  // The free minimum (-2, -1) violates both bounds and the row; at the optimum only the row holds:
  // 4 x_1 - 2 x_2 + 6 = -2 x_1 + 4 x_2 = y, x_1 + x_2 = 2.
  QpProblem p(2, 1);
  p.H << 4.0, -2.0, -2.0, 4.0;
  p.g << 6.0, 0.0;
  p.x_lower << 0.0, 0.0;
  p.A << 1.0, 1.0;
  p.a_lower << 2.0;
  QpSolver solver(2, 1);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {0.5, 1.5});
  expectVector(r.y_a, {5.0});
  EXPECT_EQ(r.active, 1);
}

TEST(Qp, EqualLimitsAreEqualitiesWithMultipliersOfAnySign) {
  QpProblem p(3, 1);  // x_1 = 1, x_2 = x_3 = 3/2 = y_a, y_x1 = 1 - 3/2
  p.x_lower(0) = p.x_upper(0) = 1.0;
  p.A << 1.0, 1.0, 1.0;
  p.a_lower << 4.0;
  p.a_upper << 4.0;
  QpSolver solver(3, 1);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  EXPECT_EQ(r.x(0), 1.0);
  expectVector(r.x, {1.0, 1.5, 1.5});
  expectVector(r.y_a, {1.5});
  expectVector(r.y_x, {-0.5, 0.0, 0.0});
  EXPECT_EQ(r.active, 2);
}

TEST(Qp, AllUnknownsFixedLeavesOnlyMultipliers) {
  QpProblem p(2, 0);
  p.g << 1.0, -1.0;
  p.x_lower << 2.0, 3.0;
  p.x_upper = p.x_lower;
  QpSolver solver(2, 0);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  EXPECT_EQ(r.x, p.x_lower);
  expectVector(r.y_x, {3.0, 2.0});
}

TEST(Qp, DuplicateRowsShareTheMultiplier) {
  QpProblem p(2, 3);
  p.A << 1.0, 1.0, 1.0, 1.0, 2.0, 2.0;
  p.a_lower << 2.0, 2.0, 4.0;
  QpSolver solver(2, 3);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 1.0});
  EXPECT_NEAR(r.y_a(0) + r.y_a(1) + 2.0 * r.y_a(2), 1.0, 1e-14);
  EXPECT_GE(r.y_a.minCoeff(), 0.0);
}

TEST(Qp, RowThatRepeatsABoundIsHarmless) {
  QpProblem p(2, 1);
  p.g << 1.0, 0.0;
  p.x_lower << 2.0, -kInfinity;
  p.A << 1.0, 0.0;
  p.a_lower << 2.0;
  QpSolver solver(2, 1);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {2.0, 0.0});
  EXPECT_NEAR(r.y_x(0) + r.y_a(0), 3.0, 1e-14);
}

TEST(Qp, ConsistentDependentEqualitiesAreSolved) {
  QpProblem p(2, 3);
  p.A << 1.0, 1.0, 1.0, -1.0, 3.0, 1.0;  // the third is twice the first plus the second
  p.a_lower << 2.0, 0.5, 4.5;
  p.a_upper = p.a_lower;
  QpSolver solver(2, 3);
  const QpResult& r = solveOnce(solver, p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.25, 0.75});
}

TEST(Qp, SmallerProblemsFitInTheSameSolver) {
  QpSolver solver(6, 3);
  const QpResult& r = solver.solve(nearestPointOfHalfPlane());
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 1.0});
  QpProblem p(3, 0);
  p.g << 1.0, 2.0, 3.0;
  ASSERT_EQ(solver.solve(p).status, SolveStatus::kSolved);
  expectVector(r.x, {-1.0, -2.0, -3.0});
  EXPECT_EQ(r.y_a.size(), 0);
}

TEST(Qp, WarmSolveWithTheSameActiveSetTakesOneIteration) {
  QpProblem p = nearestPointOfHalfPlane();
  QpSolver solver(2, 1);
  EXPECT_GT(solver.solve(p).iterations, 1);
  p.a_lower << 3.0;
  const QpResult& r = solver.solve(p);
  EXPECT_EQ(r.iterations, 1);
  expectVector(r.x, {1.5, 1.5});
  expectVector(r.y_a, {1.5});
  p.H *= 2.0;
  EXPECT_EQ(solver.solve(p).iterations, 1);
  expectVector(r.y_a, {3.0});
  p.A << 2.0, 1.0;  // x = y/2 (2, 1), 2.5 y = 3
  EXPECT_EQ(solver.solve(p).iterations, 1);
  expectVector(r.x, {1.2, 0.6});
}

TEST(Qp, ForgetMakesTheNextSolveCold) {
  QpSolver solver(2, 1);
  const int cold = solver.solve(nearestPointOfHalfPlane()).iterations;
  ASSERT_LT(solver.solve(nearestPointOfHalfPlane()).iterations, cold);
  solver.forget();
  EXPECT_EQ(solver.solve(nearestPointOfHalfPlane()).iterations, cold);
}

TEST(Qp, WarmStartDropsConstraintsThatNoLongerPush) {
  QpProblem p(2, 1);
  p.A << 1.0, 1.0;
  p.g << -4.0, -1.0;
  p.x_upper << 1.0, 5.0;
  p.a_upper << 1.5;
  QpSolver solver(2, 1);
  const QpResult& r = solver.solve(p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 0.5});  // y_a = 0.5 - 1, y_x = 1 - 4 + 0.5
  expectVector(r.y_a, {-0.5});
  expectVector(r.y_x, {-2.5, 0.0});
  p.g << 0.0, -1.0;
  ASSERT_EQ(solver.solve(p).status, SolveStatus::kSolved);
  expectVector(r.x, {0.0, 1.0});
  EXPECT_EQ(r.active, 0);
}

TEST(Qp, LimitThatVanishedIsNotRemembered) {
  QpProblem p = nearestPointOfHalfPlane();
  QpSolver solver(2, 1);
  ASSERT_EQ(solver.solve(p).active, 1);
  p.a_lower << -kInfinity;
  const QpResult& r = solver.solve(p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {0.0, 0.0});
}

TEST(Qp, SolverCanBeMoved) {
  QpSolver first(2, 1);
  QpSolver second = std::move(first);
  EXPECT_TRUE(second.solve(nearestPointOfHalfPlane()).usable());
}

}  // namespace optim_qp_test
}  // namespace fpc::testing
