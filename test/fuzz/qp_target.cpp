// Bytes as a quadratic programme: sizes, then numbers of few and odd values, so that degenerate
// rows, equal limits and semidefinite Hessians come up by themselves.
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fuzz/bytes.hpp"
#include "fuzz/targets.hpp"
#include "optim/qp.hpp"

namespace fpc::fuzz {
namespace {

using Eigen::Index;

double finite(Bytes& bytes) {
  const double value = bytes.number();
  return std::isfinite(value) ? value : 7.0;
}

QpProblem problemOf(Bytes& bytes) {
  const Index n = 1 + bytes.below(6), m = bytes.below(8),
              rank = bytes.below(static_cast<int>(n) + 1);
  QpProblem p(n, m);
  Matrix root(n, rank);
  for (double& value : flat(root)) value = finite(bytes);
  p.H = root * root.transpose();
  for (double& value : p.g) value = finite(bytes);
  for (double& value : flat(p.A)) value = finite(bytes);
  const auto limits = [&](Vector& lower, Vector& upper) {
    for (Index i = 0; i < lower.size(); ++i) {
      const double a = bytes.number(), b = bytes.number();
      if (a == b && std::isinf(a)) continue;
      lower[i] = std::min(a, b);
      upper[i] = std::max(a, b);
    }
  };
  limits(p.x_lower, p.x_upper);
  limits(p.a_lower, p.a_upper);
  return p;
}

/// What a number of one rounding in x or in a multiplier makes of the stationarity: no solver can
/// promise less, and large numbers that cancel (1e24 beside 1) leave much of it.
double rounding(const QpProblem& p, const QpResult& r) {
  const Vector terms = p.H.cwiseAbs() * r.x.cwiseAbs() + p.g.cwiseAbs() + r.y_x.cwiseAbs() +
                       p.A.transpose().cwiseAbs() * r.y_a.cwiseAbs();
  return 4.0 * std::numeric_limits<double>::epsilon() * terms.maxCoeff();
}

void check(const QpProblem& p, const QpResult& result, const char* how) {
  const auto fail = [&](const std::string& what) {
    throw std::logic_error(what + " (" + how + "), n " + std::to_string(p.g.size()) + ", m " +
                           std::to_string(p.A.rows()));
  };
  if (result.status == SolveStatus::kSolved) {
    if (!(kktResidual(p, result.x, result.y_x, result.y_a) <= 1e-9 + rounding(p, result)))
      fail("solved with a residual");
  } else if (result.status == SolveStatus::kInfeasible) {
    if (!(farkasRadius(p, result.y_x, result.y_a) >= 100.0)) fail("infeasible without certificate");
  } else if (result.status == SolveStatus::kInvalidProblem) {
    fail("a valid problem called invalid");
  }
}

}  // namespace

void qp(const std::string& text) {
  Bytes bytes(text);
  const QpProblem first = problemOf(bytes);
  QpProblem second = first;
  for (double& value : second.g) value = finite(bytes);
  QpSolver solver(first.g.size(), first.A.rows());
  check(first, solver.solve(first, false), "cold");
  check(second, solver.solve(second, true), "warm");
}

}  // namespace fpc::fuzz
