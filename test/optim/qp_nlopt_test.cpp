// The QP solver beside an unrelated one: NLopt's sequential quadratic programming (kraft1994) on
// scaled problems.
#include <nlopt.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "optim/qp_problems.hpp"

namespace fpc::testing {
namespace optim_qp_nlopt_test {

using VectorMap = Eigen::Map<const Vector>;

double cost(unsigned n, const double* x, double* gradient, void* data) {
  const QpProblem& p = *static_cast<const QpProblem*>(data);
  const VectorMap v(x, n);
  const Vector Hx = p.H * v;
  if (gradient != nullptr) Eigen::Map<Vector>(gradient, n) = Hx + p.g;
  return v.dot(0.5 * Hx + p.g);
}

/// One side of a row as sign (a'x - limit) <= 0.
struct RowSide {
  Vector a;
  double limit{};
  double sign{};
};

double rowSide(unsigned n, const double* x, double* gradient, void* data) {
  const RowSide& side = *static_cast<const RowSide*>(data);
  if (gradient != nullptr) Eigen::Map<Vector>(gradient, n) = side.sign * side.a;
  return side.sign * (side.a.dot(VectorMap(x, n)) - side.limit);
}

/// @return x, or nothing if NLopt gave up
Vector solveWithSlsqp(const QpProblem& p) {
  const auto n = static_cast<unsigned>(p.g.size());
  const std::unique_ptr<nlopt_opt_s, decltype(&nlopt_destroy)> opt(nlopt_create(NLOPT_LD_SLSQP, n),
                                                                   &nlopt_destroy);
  QpProblem data = p;
  nlopt_set_min_objective(opt.get(), cost, &data);
  nlopt_set_lower_bounds(opt.get(), p.x_lower.data());
  nlopt_set_upper_bounds(opt.get(), p.x_upper.data());
  std::vector<RowSide> sides;
  for (Eigen::Index i = 0; i < p.a_lower.size(); ++i) {
    const Vector a = p.A.row(i).transpose();
    if (std::isfinite(p.a_lower(i))) sides.push_back({a, p.a_lower(i), -1.0});
    if (std::isfinite(p.a_upper(i))) sides.push_back({a, p.a_upper(i), 1.0});
  }
  for (RowSide& side : sides) nlopt_add_inequality_constraint(opt.get(), rowSide, &side, 1e-12);
  nlopt_set_ftol_rel(opt.get(), 1e-15);
  nlopt_set_xtol_rel(opt.get(), 1e-12);
  nlopt_set_maxeval(opt.get(), 2000);
  Vector x = Vector::Zero(p.g.size()).cwiseMax(p.x_lower).cwiseMin(p.x_upper);
  double value = 0.0;
  const nlopt_result code = nlopt_optimize(opt.get(), x.data(), &value);
  return code > 0 || code == NLOPT_ROUNDOFF_LIMITED ? x : Vector();
}

TEST(QpBesideNlopt, SlsqpFindsTheSamePointOnScaledProblems) {
  int compared = 0;
  double worst = 0.0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const Eigen::Index n = draw.index(1, 20), m = draw.index(0, 10);
    const QpProblem p = knownQp(draw, n, m).problem;
    QpSolver solver(n, m);
    const QpResult& r = solver.solve(p);
    ASSERT_EQ(r.status, SolveStatus::kSolved);
    const Vector x = solveWithSlsqp(p);
    if (x.size() == 0) continue;
    ++compared;
    worst = std::max(worst, (x - r.x).lpNorm<Eigen::Infinity>());
    EXPECT_LE((x - r.x).lpNorm<Eigen::Infinity>(), 1e-6);
    const auto costOf = [&](const Vector& v) { return v.dot(0.5 * p.H * v + p.g); };
    EXPECT_LE(costOf(r.x), costOf(x) + 1e-9 * (1.0 + std::abs(costOf(x))));
  }
  EXPECT_GE(compared, 190);
  std::cout << "compared " << compared << ", largest difference " << worst << "\n";
}

}  // namespace optim_qp_nlopt_test
}  // namespace fpc::testing
