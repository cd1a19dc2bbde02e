// How wrong somebody else's answer of a quadratic programme is, beside ours.
#pragma once

#include <algorithm>
#include <cmath>

#include "fmbpc/base/types.hpp"
#include "optim/qp.hpp"

namespace fpc::bench {

inline double costOf(const QpProblem& p, const Vector& x) {
  return 0.5 * x.dot(p.H * x) + p.g.dot(x);
}

/// Largest violation of a limit, relative to 1 + |x|, and how far the cost is from ours. (Where the
/// Hessian is semidefinite there may be many answers.) Infinite if x is no finite point of this
/// size: no comparison would notice it.
inline double errorOf(const QpProblem& p, const Vector& x, const Vector& ours) {
  if (x.size() != ours.size() || !x.allFinite()) return kInfinity;
  double violation = 0.0;
  const Vector Ax = p.A * x;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    violation = std::max({violation, p.x_lower(i) - x(i), x(i) - p.x_upper(i)});
  for (Eigen::Index i = 0; i < Ax.size(); ++i)
    violation = std::max({violation, p.a_lower(i) - Ax(i), Ax(i) - p.a_upper(i)});
  const double cost = costOf(p, ours);
  return std::max(violation / (1.0 + ours.lpNorm<Eigen::Infinity>()),
                  std::abs(costOf(p, x) - cost) / (1.0 + std::abs(cost)));
}

}  // namespace fpc::bench
