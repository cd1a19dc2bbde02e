// Private: unknowns of small sizes. Tolerances of the QP solver take an unknown for one of size 1;
// where the data say that it is smaller it is replaced by a multiple of itself. None is taken for
// larger: rows and cost tell a size within orders of magnitude only, and a tolerance must not grow
// by a guess.
#pragma once

#include "optim/qp.hpp"

namespace fpc::qp {

/// A problem in v, x = s v: powers of two, so that nothing is rounded.
class ScaledProblem {
 public:
  void resize(Eigen::Index n, Eigen::Index m);
  /// Finds s by what bounds, rows and cost say of each unknown alone: its box, or the median of
  /// |limit|, |limit_i / a_ij| and |g_j / H_jj|, whichever is less. Sizes from 2^-7 on count as 1.
  /// @return false if all are 1: then the problem is used as it is
  bool scale(const QpProblem& given);
  const QpProblem& problem() const { return scaled_; }
  const Vector& size() const { return size_; }  ///< s

 private:
  void readLimits(const QpProblem& p);
  bool mostlyUsual(const QpProblem& p, Eigen::Index j) const;
  double sizeOf(const QpProblem& p, Eigen::Index j);

  QpProblem scaled_;
  Vector size_, said_, low_, high_;
  Eigen::Index most_{};  // numbers that limits can say of an unknown
};

}  // namespace fpc::qp
