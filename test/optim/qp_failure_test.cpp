// Every way in which the QP solver can fail, and what its KKT residual sees.
#include "optim/qp.hpp"

#include <string>

#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_failure_test {

/// Infeasible counts only with its proof.
SolveStatus statusOf(const QpProblem& p) {
  QpSolver solver(4, 4);
  const QpResult& r = solver.solve(p, false);
  if (r.status == SolveStatus::kInfeasible) {
    EXPECT_TRUE(provesInfeasible(p, r.y_x, r.y_a, 100.0));
    EXPECT_GE(farkasRadius(p, r.y_x, r.y_a), 100.0);
  }
  return r.status;
}

TEST(Qp, ContradictionsAreInfeasible) {
  QpProblem row_against_bounds = nearestPointOfHalfPlane();
  row_against_bounds.x_upper << 0.9, 1.0;
  EXPECT_EQ(statusOf(row_against_bounds), SolveStatus::kInfeasible);

  QpProblem rows(2, 2);
  rows.A << 1.0, 1.0, 2.0, 2.0;
  rows.a_lower << 2.0, -kInfinity;
  rows.a_upper << kInfinity, 3.9;
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

TEST(Qp, IndefiniteHessianIsANumericalError) {
  QpProblem p(2, 0);
  p.H << 1.0, 2.0, 2.0, 1.0;
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.H << 1.0, 1.0, 1.0, 1.0 - 1e-8;
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.H << 1.0, 0.0, 0.0, -1.0;
  p.x_lower(1) = p.x_upper(1) = 0.0;  // the bad direction is fixed, H is still not what it must be
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
}

TEST(Qp, ACostWithoutAMinimumIsANumericalError) {
  QpProblem p(2, 0);
  p.H << 1.0, 1.0, 1.0, 1.0;
  p.g << 1.0, -1.0;  // falls along (-1, 1)
  EXPECT_EQ(statusOf(p), SolveStatus::kNumericalError);
  p.x_upper(1) = 5.0;  // until there: x_0 = -1 - x_1
  QpSolver solver(2, 0);
  const QpResult& r = solver.solve(p);
  ASSERT_EQ(r.status, SolveStatus::kSolved);
  EXPECT_LE((r.x - Eigen::Vector2d(-6.0, 5.0)).norm(), 1e-12);
  EXPECT_NEAR(r.y_x(1), -2.0, 1e-12);
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
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
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
    (p.*limit)(0) = kNaN;
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
  p.a_lower(0) = kInfinity;
  EXPECT_EQ(statusOf(p), SolveStatus::kInvalidProblem);
  p = nearestPointOfHalfPlane();
  p.x_lower(0) = p.x_upper(0) = -kInfinity;
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
  EXPECT_LE((r.x - Vector::Ones(2)).norm(), 1e-14);
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
  for (const double bad : {0.0, -1.0, 1.0, kNaN}) {
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
  p.x_upper << kInfinity;
  EXPECT_DOUBLE_EQ(residual(2.0, -1.0), 1.0 / 4.0);  // a multiplier without its limit
  EXPECT_EQ(residual(kNaN, 0.0), kInfinity);
  EXPECT_THROW(kktResidual(p, Vector(2), Vector(1), Vector(0)), InputError);
}

TEST(KktResidual, RowOfTheWrongSignIsSeen) {
  QpProblem p = nearestPointOfHalfPlane();
  const Vector x = Vector::Constant(2, 1.0), none = Vector::Zero(2);
  EXPECT_EQ(kktResidual(p, x, none, Vector::Constant(1, 1.0)), 0.0);
  p.a_lower << -kInfinity;
  p.a_upper << 2.0;  // the same multiplier now pulls to the wrong side
  EXPECT_DOUBLE_EQ(kktResidual(p, x, none, Vector::Constant(1, 1.0)), 0.5);
}

}  // namespace optim_qp_failure_test
}  // namespace fpc::testing
