// The QP solver that leaves the computer with an exported law (src/export/clp/qp.c) against the one
// in process: known answers, a controller's problems, degenerate data, limits of its work.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_exported_qp_test {

struct ExportedAnswer {
  SolveStatus status;
  Vector x;
  int iterations, active;
};

namespace n1 {
#define CLP_N 1
#define CLP_M 2
#include "optim/exported_qp.hpp"
}  // namespace n1
namespace n12 {
#define CLP_N 12
#define CLP_M 18
#include "optim/exported_qp.hpp"
}  // namespace n12
namespace bounds {
#define CLP_N 42
#define CLP_M 0
#include "optim/exported_qp.hpp"
}  // namespace bounds
namespace moves {
#define CLP_N 42
#define CLP_M 41
#include "optim/exported_qp.hpp"
}  // namespace moves
namespace outputs {
#define CLP_N 44
#define CLP_M 125
#include "optim/exported_qp.hpp"
}  // namespace outputs

constexpr int kMost = 1000;

double distance(const Vector& a, const Vector& b) { return (a - b).lpNorm<Eigen::Infinity>(); }

TEST(ExportedQp, KnownOptimaAreFound) {
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const KnownQp known = knownQp(draw, 12, 18);
    const ExportedAnswer answer = n12::solve(known.problem);
    ASSERT_EQ(SolveStatus::kSolved, answer.status);
    ASSERT_LE(distance(answer.x, known.x), 1e-10);
    ASSERT_LE(answer.iterations, kMost);
    const KnownQp one = knownQp(draw, 1, 2);
    ASSERT_LE(distance(n1::solve(one.problem).x, one.x), 1e-10);
  }
}

template <typename Solve>
void followController(ControllerQp::Kind kind, const Solve& solve, int& most_active) {
  ControllerQp controller(kind);
  QpSolver solver(controller.problem.g.size(), controller.problem.a_lower.size());
  most_active = 0;
  for (int k = 0; k < 400; ++k) {
    SCOPED_TRACE(k);
    controller.update(0.05 * k);
    const QpResult& here = solver.solve(controller.problem);
    const ExportedAnswer there = solve(controller.problem, kMost);
    ASSERT_EQ(SolveStatus::kSolved, here.status);
    ASSERT_EQ(SolveStatus::kSolved, there.status);
    ASSERT_LE(distance(here.x, there.x), 1e-9 * 1600.0);  // of the span of the inputs
    most_active = std::max(most_active, there.active);
  }
}

TEST(ExportedQp, AControllersProblemsHaveTheSameAnswersAsInProcess) {
  int active = 0;
  followController(ControllerQp::Kind::kBounds, bounds::solve, active);
  EXPECT_GT(active, 20);
  followController(ControllerQp::Kind::kMoves, moves::solve, active);
  EXPECT_GT(active, 20);
  followController(ControllerQp::Kind::kOutputs, outputs::solve, active);
  EXPECT_GT(active, 20);
}

/// Rows twice, rows that repeat a bound, fixed unknowns, corners in which more limits meet than
/// there are unknowns.
QpProblem degenerate(Draw& draw) {
  QpProblem p = knownQp(draw, 12, 18).problem;
  const Vector corner = draw.vector(12);
  for (Eigen::Index i = 0; i < 12; ++i) {
    p.x_lower(i) = corner(i) - (draw.chance(0.5) ? 0.0 : 1.0);
    p.x_upper(i) = draw.chance(0.2) ? p.x_lower(i) : corner(i) + 1.0;
    if (p.x_lower(i) == p.x_upper(i)) p.x_lower(i) = p.x_upper(i) = corner(i);
  }
  for (Eigen::Index k = 0; k < 18; ++k) {
    if (k % 3 == 1) p.A.row(k) = p.A.row(k - 1);
    if (k % 3 == 2) p.A.row(k) = 2.0 * Vector::Unit(12, draw.index(0, 11)).transpose();
    const double at = p.A.row(k).dot(corner);
    p.a_lower(k) = draw.chance(0.5) ? at : -kInfinity;
    p.a_upper(k) = draw.chance(0.1) ? at : kInfinity;
  }
  return p;
}

TEST(ExportedQp, DegenerateLimitsDoNotDisturbIt) {
  int solved = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const QpProblem problem = degenerate(draw);
    QpSolver solver(12, 18);
    const QpResult& here = solver.solve(problem);
    const ExportedAnswer there = n12::solve(problem);
    ASSERT_EQ(here.status, SolveStatus::kSolved);
    ASSERT_LE(there.iterations, kMost);
    ASSERT_EQ(there.status, SolveStatus::kSolved);
    ASSERT_LE(distance(here.x, there.x), 1e-9);
    ++solved;
  }
  EXPECT_EQ(1500, solved);
}

TEST(ExportedQp, ItStopsAfterTheAllowedWorkingSets) {
  Draw draw(3);
  const KnownQp known = knownQp(draw, 12, 18);
  const int needed = n12::solve(known.problem).iterations;
  ASSERT_GT(needed, 3);
  for (int most = 0; most < needed; ++most) {
    const ExportedAnswer answer = n12::solve(known.problem, most);
    EXPECT_EQ(SolveStatus::kIterationLimit, answer.status);
    EXPECT_EQ(most, answer.iterations);
  }
  EXPECT_EQ(SolveStatus::kSolved, n12::solve(known.problem, needed).status);
}

TEST(ExportedQp, WhatHasNoAnswerGetsNone) {
  Draw draw(5);
  QpProblem p = knownQp(draw, 12, 18).problem;
  QpProblem indefinite = p;
  indefinite.H(4, 4) = -1.0;
  EXPECT_EQ(SolveStatus::kNumericalError, n12::solve(indefinite).status);
  QpProblem contradictory = p;
  contradictory.A.row(0).setZero();
  contradictory.A(0, 3) = 1.0;
  contradictory.a_lower(0) = 20.0;
  contradictory.a_upper(0) = 30.0;
  contradictory.x_lower(3) = -1.0;
  contradictory.x_upper(3) = 1.0;
  EXPECT_EQ(SolveStatus::kNumericalError, n12::solve(contradictory).status);
  QpProblem no_number = p;
  no_number.g(2) = std::nan("");
  EXPECT_NE(SolveStatus::kSolved, n12::solve(no_number).status);
  no_number = p;
  no_number.H(5, 2) = std::nan("");
  EXPECT_NE(SolveStatus::kSolved, n12::solve(no_number).status);
}

}  // namespace optim_exported_qp_test
}  // namespace fpc::testing
