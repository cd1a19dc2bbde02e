// Every problem of the public MPC set in the public records is solved, cold and warm, with default
// settings.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "optim/mpc_qp_set.hpp"
#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_mpc_set_test {

const char* nameOf(SolveStatus status) {
  if (status == SolveStatus::kSolved) return "solved";
  if (status == SolveStatus::kInfeasible) return "infeasible";
  return status == SolveStatus::kIterationLimit ? "iteration limit" : "numerical error";
}

/// Microseconds of one solve.
double timed(QpSolver& solver, const QpProblem& p, bool warm) {
  const auto start = std::chrono::steady_clock::now();
  solver.solve(p, warm);
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

void check(const std::string& name, const QpProblem& p) {
  SCOPED_TRACE(name);
  QpSolver solver(p.g.size(), p.a_lower.size());
  for (const bool warm : {false, true}) {
    const double us = timed(solver, p, warm);
    const QpResult r = solver.solve(p, warm);
    const double kkt = kktResidual(p, r.x, r.y_x, r.y_a);
    const double absolute = absoluteResiduals(p, r).worst();
    std::printf("%-11s %4ld %4ld  %s  %-15s %8.1e %8.1e %6d %10.1f\n", name.c_str(),
                static_cast<long>(p.g.size()), static_cast<long>(p.a_lower.size()),
                warm ? "warm" : "cold", nameOf(r.status), kkt, absolute, r.iterations, us);
    EXPECT_EQ(r.status, SolveStatus::kSolved);
    EXPECT_LE(kkt, 1e-9);
    EXPECT_LE(absolute, 1e-9);
  }
}

/// The folder of the set, or an empty path.
std::filesystem::path setFolder() {
  const char* data = std::getenv("FMBPC_DATA");
  const auto folder = std::filesystem::path(data == nullptr ? "" : data) / "mpc_qp";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

TEST(QpMpcSet, EveryProblemIsSolved) {
  const auto folder = setFolder();
  if (folder.empty()) GTEST_SKIP() << "no folder mpc_qp in FMBPC_DATA";
  std::printf("%-11s %4s %4s  %s  %-15s %8s %8s %6s %10s\n", "problem", "n", "m", "from", "status",
              "KKT", "absolute", "sets", "us");
  const MpcQpSet set = readMpcQpSet(folder);
  EXPECT_FALSE(set.empty());
  for (const auto& [name, arrays] : set) check(name, toProblem(arrays));
}

/// The problem from another state of the robot, with other forces allowed and another aim.
void disturb(Draw& draw, QpProblem& p) {
  constexpr Eigen::Index kDynamics = 192, kState = 12;  // equality rows, the last ones
  const Eigen::Index first = p.a_lower.size() - kDynamics;
  const double size = std::pow(10.0, draw.uniform(-2.0, 1.0));
  const Eigen::Index rows = draw.chance(0.5) ? kState : kDynamics;
  p.a_lower.segment(first, rows) += draw.vector(rows, size);
  p.a_upper.tail(kDynamics) = p.a_lower.tail(kDynamics);
  if (draw.chance(0.5)) p.g += draw.vector(p.g.size(), 10.0);
  const double force = draw.uniform(3.0, 30.0);
  for (double& limit : p.x_upper) limit = std::min(limit, std::isinf(limit) ? limit : force);
}

TEST(QpMpcSet, TheLargeOneIsSolvedFromOtherStatesToo) {
  const std::string name = "QUADCMPC3";
  const auto folder = setFolder();
  if (!std::filesystem::exists(folder / (name + ".npz"))) GTEST_SKIP() << "no " << name;
  const QpProblem base = toProblem(readMpcQpSet(folder, name).at(name));
  QpSolver solver(base.g.size(), base.a_lower.size());
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    QpProblem p = base;
    disturb(draw, p);
    const QpResult& r = solver.solve(p, seed % 2 == 0);
    ASSERT_EQ(r.status, SolveStatus::kSolved);
    ASSERT_LE(kktResidual(p, r.x, r.y_x, r.y_a), 1e-12);
  }
}

}  // namespace optim_qp_mpc_set_test
}  // namespace fpc::testing
