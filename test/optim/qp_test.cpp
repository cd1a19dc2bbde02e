// Small quadratic programmes whose primal and dual answers are known on paper, and every way to
// fail.
#include "fmbpc/optim/qp.hpp"

#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const QpResult& solveOnce(QpSolver& solver, const QpProblem& p) { return solver.solve(p, false); }

SolveStatus statusOf(const QpProblem& p) {
  QpSolver solver(4, 4);
  return solveOnce(solver, p).status;
}

void expectVector(const Vector& actual, std::initializer_list<double> expected) {
  ASSERT_EQ(actual.size(), static_cast<Eigen::Index>(expected.size()));
  Eigen::Index i = 0;
  for (const double value : expected) EXPECT_NEAR(actual(i++), value, 1e-14) << "entry " << i - 1;
}

/// min 1/2 |x|^2 over two unknowns with x_1 + x_2 >= 2: x = (1, 1), y_a = 1.
QpProblem nearestPointOfHalfPlane() {
  QpProblem p(2, 1);
  p.A << 1.0, 1.0;
  p.a_lower << 2.0;
  return p;
}

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
  p.x_lower << 2.0, -kInf;
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

TEST(Qp, ContradictionsAreInfeasible) {
  QpProblem row_against_bounds = nearestPointOfHalfPlane();
  row_against_bounds.x_upper << 0.9, 1.0;
  EXPECT_EQ(statusOf(row_against_bounds), SolveStatus::kInfeasible);

  QpProblem rows(2, 2);
  rows.A << 1.0, 1.0, 2.0, 2.0;
  rows.a_lower << 2.0, -kInf;
  rows.a_upper << kInf, 3.9;
  EXPECT_EQ(statusOf(rows), SolveStatus::kInfeasible);

  rows.a_lower << 2.0, 4.1;
  rows.a_upper << 2.0, 4.1;
  EXPECT_EQ(statusOf(rows), SolveStatus::kInfeasible);

  QpProblem zero_row(2, 1);
  zero_row.a_lower << 1e-6;
  EXPECT_EQ(statusOf(zero_row), SolveStatus::kInfeasible);

  QpProblem fixed = nearestPointOfHalfPlane();
  fixed.x_lower = fixed.x_upper = Vector::Zero(2);
  EXPECT_EQ(statusOf(fixed), SolveStatus::kInfeasible);
}

TEST(Qp, IterationCapIsReported) {
  QpSettings settings;
  settings.max_iterations = 1;
  QpSolver capped(2, 1, settings);
  EXPECT_EQ(capped.solve(nearestPointOfHalfPlane()).status, SolveStatus::kIterationLimit);
  settings.max_iterations = 2;
  QpSolver enough(2, 1, settings);
  EXPECT_EQ(enough.solve(nearestPointOfHalfPlane()).status, SolveStatus::kSolved);
}

TEST(Qp, IndefiniteOrSingularHessianIsANumericalError) {
  QpProblem p(2, 0);
  p.H << 1.0, 2.0, 2.0, 1.0;
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.H << 1.0, 1.0, 1.0, 1.0;
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.H.setZero();
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.H << 1.0, 0.0, 0.0, -1.0;
  p.x_lower(1) = p.x_upper(1) = 0.0;  // the bad direction is fixed, H is still not what it must be
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
}

TEST(Qp, AConcaveProblemIsNotSolvedByTheRememberedBounds) {
  QpProblem p(1, 0);
  p.g << -3.0;
  p.x_lower << 0.0;
  p.x_upper << 1.0;
  QpSolver solver(1, 0);
  ASSERT_EQ(solver.solve(p).active, 1);
  p.H << -1.0;
  EXPECT_EQ(solver.solve(p).status, SolveStatus::kNumericalError);
}

TEST(Qp, DataThatAreNotFiniteAreInvalid) {
  const QpProblem good = nearestPointOfHalfPlane();
  for (const double bad : {kNan, kInf, -kInf}) {
    QpProblem p = good;
    p.H(0, 1) = bad;
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem) << "H upper " << bad;
    p = good;
    p.H(1, 0) = bad;
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem) << "H lower " << bad;
    p = good;
    p.g(1) = bad;
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem) << "g " << bad;
    p = good;
    p.A(0, 1) = bad;
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem) << "A " << bad;
  }
  for (Vector QpProblem::*limit :
       {&QpProblem::x_lower, &QpProblem::x_upper, &QpProblem::a_lower, &QpProblem::a_upper}) {
    QpProblem p = good;
    (p.*limit)(0) = kNan;
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  }
}

TEST(Qp, ImpossibleLimitsAreInvalid) {
  QpProblem p = nearestPointOfHalfPlane();
  p.x_lower(0) = 1.0;
  p.x_upper(0) = 0.0;
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  p = nearestPointOfHalfPlane();
  p.a_upper(0) = 1.0;
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  p = nearestPointOfHalfPlane();
  p.a_lower(0) = kInf;
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  p = nearestPointOfHalfPlane();
  p.x_lower(0) = p.x_upper(0) = -kInf;
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
}

TEST(Qp, WrongSizesAreInvalid) {
  EXPECT_EQ(statusOf(QpProblem()), SolveStatus::kInvalidProblem);
  EXPECT_EQ(statusOf(QpProblem(5, 0)), SolveStatus::kInvalidProblem);  // room for 4
  EXPECT_EQ(statusOf(QpProblem(2, 5)), SolveStatus::kInvalidProblem);
  for (Vector QpProblem::*vector : {&QpProblem::g, &QpProblem::x_lower, &QpProblem::x_upper,
                                    &QpProblem::a_lower, &QpProblem::a_upper}) {
    QpProblem p = nearestPointOfHalfPlane();
    (p.*vector) = Vector::Zero(3);
    EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  }
  QpProblem p = nearestPointOfHalfPlane();
  p.H = Matrix::Identity(2, 3);
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  p = nearestPointOfHalfPlane();
  p.A = Matrix::Zero(1, 3);
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
}

TEST(Qp, FailureIsNotRememberedAndTheNextSolveIsRight) {
  QpSolver solver(2, 1);
  QpProblem bad = nearestPointOfHalfPlane();
  bad.x_upper << 0.5, 0.5;
  ASSERT_EQ(solver.solve(bad).status, SolveStatus::kInfeasible);
  const QpResult& r = solver.solve(nearestPointOfHalfPlane());
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {1.0, 1.0});
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
  p.a_lower << -kInf;
  const QpResult& r = solver.solve(p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  expectVector(r.x, {0.0, 0.0});
}

TEST(Qp, SolverCanBeMoved) {
  QpSolver first(2, 1);
  QpSolver second = std::move(first);
  EXPECT_TRUE(second.solve(nearestPointOfHalfPlane()).usable());
}

TEST(QpSettings, BadValuesAreNamed) {
  const auto messageOf = [](const QpSettings& settings) -> std::string {
    try {
      QpSolver solver(1, 0, settings);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(messageOf({}), "");
  EXPECT_NE(messageOf({0, 1e-10}).find("max_iterations"), std::string::npos);
  for (const double bad : {0.0, -1.0, 1.0, kNan}) {
    EXPECT_NE(messageOf({10, bad}).find("feasibility_tolerance"), std::string::npos) << bad;
  }
}

TEST(QpSettings, SolverNeedsSizes) {
  EXPECT_THROW(QpSolver(0, 0), InputError);
  EXPECT_THROW(QpSolver(1, -1), InputError);
}

TEST(KktResidual, EachKindOfErrorIsSeen) {
  QpProblem p(1, 0);  // x - 3, x <= 2
  p.g << -3.0;
  p.x_upper << 2.0;
  const auto residual = [&](double x, double y) {
    return kktResidual(p, Vector::Constant(1, x), Vector::Constant(1, y), Vector(0));
  };
  EXPECT_EQ(residual(2.0, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(residual(2.0, -3.0), 2.0 / 4.0);  // stationarity, scale 1 + |g|
  EXPECT_DOUBLE_EQ(residual(3.0, 0.0), 1.0 / 6.0);   // feasibility, scale 2 + 1 + 3
  EXPECT_DOUBLE_EQ(residual(1.0, -2.0), 1.0 / 4.0);  // distance 1 of 4, multiplier 2 of 4
  p.x_upper << kInf;
  EXPECT_DOUBLE_EQ(residual(2.0, -1.0), 1.0 / 4.0);  // a multiplier without its limit
  EXPECT_EQ(residual(kNan, 0.0), kInf);
  EXPECT_THROW(kktResidual(p, Vector(2), Vector(1), Vector(0)), InputError);
}

TEST(KktResidual, RowOfTheWrongSignIsSeen) {
  QpProblem p = nearestPointOfHalfPlane();
  const Vector x = Vector::Constant(2, 1.0), none = Vector::Zero(2);
  EXPECT_EQ(kktResidual(p, x, none, Vector::Constant(1, 1.0)), 0.0);
  p.a_lower << -kInf;
  p.a_upper << 2.0;  // the same multiplier now pulls to the wrong side
  EXPECT_DOUBLE_EQ(kktResidual(p, x, none, Vector::Constant(1, 1.0)), 0.5);
}

}  // namespace
}  // namespace fpc
