// The QP solver on problems whose unknowns are of very different sizes.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_units_test {

/// The same problem in other units of its unknowns.
QpProblem inUnits(const QpProblem& given, const Vector& unit) {
  QpProblem p = given;
  const Vector inverse = unit.cwiseInverse();
  p.H = inverse.asDiagonal() * given.H * inverse.asDiagonal();
  p.A = given.A * inverse.asDiagonal();
  p.g = given.g.cwiseProduct(inverse);
  p.x_lower = given.x_lower.cwiseProduct(unit);
  p.x_upper = given.x_upper.cwiseProduct(unit);
  return p;
}

/// 10^-e to 10^e.
Vector drawUnits(Draw& draw, Eigen::Index n, double e) {
  Vector unit(n);
  for (double& value : unit) value = std::pow(10.0, draw.uniform(-e, e));
  return unit;
}

// Where unknowns are large a proof may be too weak: then the problem is not solved, nor called
// infeasible.
TEST(QpUnits, InfeasibleProblemsAreSolvedInNoUnits) {
  for (const double e : {4.0, 8.0}) {
    int solved = 0, unproven = 0;
    for (unsigned seed = 1; seed <= 1000; ++seed) {
      Draw draw(seed);
      const Eigen::Index n = draw.index(1, 40), m = draw.index(2, 40);
      QpProblem p = knownQp(draw, n, m).problem;
      makeInfeasible(draw, p, std::pow(10.0, draw.uniform(-6.0, 1.0)));
      const bool all_alike = seed % 4 == 0;
      const Vector unit =
          all_alike ? Vector(Vector::Constant(n, drawUnits(draw, 1, e)(0))) : drawUnits(draw, n, e);
      p = inUnits(p, unit);
      QpSolver solver(n, m);
      const QpResult& r = solver.solve(p);
      solved += r.status == SolveStatus::kSolved;
      unproven += r.status != SolveStatus::kInfeasible;
      if (r.status == SolveStatus::kInfeasible) {
        ASSERT_GE(farkasRadius(p, r.y_x, r.y_a), 100.0);
      }
    }
    std::printf("units 1e-%g to 1e%g: %d of 1000 infeasible ones solved, %d without a proof\n", e,
                e, solved, unproven);
    EXPECT_EQ(solved, 0) << e;
  }
}

}  // namespace optim_qp_units_test
}  // namespace fpc::testing
