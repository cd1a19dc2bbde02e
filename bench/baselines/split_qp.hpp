// A problem with its equalities apart, as interior-point methods take it.
#pragma once

#include <cmath>
#include <vector>

#include "fmbpc/base/types.hpp"
#include "optim/qp.hpp"

namespace fpc::bench {

/// Ex = e,  lower <= Gx <= upper,  x_lower <= x <= x_upper. Rows without a finite limit are left
/// out; a bound that is an equality is a row of E and no bound.
struct SplitQp {
  Matrix E, G;
  Vector e, lower, upper, x_lower, x_upper;

  explicit SplitQp(const QpProblem& p) : x_lower(p.x_lower), x_upper(p.x_upper) {
    const Eigen::Index n = p.g.size();
    std::vector<Eigen::Index> equal, rows, bounds;
    for (Eigen::Index i = 0; i < p.a_lower.size(); ++i) {
      if (p.a_lower(i) == p.a_upper(i))
        equal.push_back(i);
      else if (std::isfinite(p.a_lower(i)) || std::isfinite(p.a_upper(i)))
        rows.push_back(i);
    }
    for (Eigen::Index i = 0; i < n; ++i)
      if (p.x_lower(i) == p.x_upper(i)) bounds.push_back(i);
    const auto n_equal = static_cast<Eigen::Index>(equal.size());
    const auto n_bounds = static_cast<Eigen::Index>(bounds.size());
    E.setZero(n_equal + n_bounds, n);
    e.resize(E.rows());
    E.topRows(n_equal) = p.A(equal, Eigen::all);
    e.head(n_equal) = p.a_lower(equal);
    for (Eigen::Index i = 0; i < n_bounds; ++i) {
      const Eigen::Index at = bounds[static_cast<std::size_t>(i)];
      E(n_equal + i, at) = 1.0;
      e(n_equal + i) = p.x_lower(at);
      x_lower(at) = -kInfinity;
      x_upper(at) = kInfinity;
    }
    G = p.A(rows, Eigen::all);
    lower = p.a_lower(rows);
    upper = p.a_upper(rows);
  }
};

}  // namespace fpc::bench
