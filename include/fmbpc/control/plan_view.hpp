// What a law shows of its plan, so that others can judge how far ahead its model may be trusted,
// and what it is told then.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// A law that plans inputs along its model. Without allocation, after a step().
class PlanView {
 public:
  virtual ~PlanView() = default;
  /// N of the plan of the last step(); 0: there is none.
  virtual Eigen::Index plannedSteps() const = 0;
  /// Sample k + i, 1 <= i < N: y, u and d as planned, stacked, n_y + n_u + n_d.
  virtual void planned(Eigen::Index i, Eigen::Ref<Vector> point) const = 0;
  /// From now on the plan's errors count only up to the first sample at which outputs and
  /// disturbances are where the model is trusted less than `threshold` (see processTrustOf()), the
  /// first `least` after the longest dead time of an input always. A law that does not plan by
  /// errors has nothing to do.
  virtual void setTrustThreshold(double /*threshold*/, Eigen::Index /*least*/) {}
};

}  // namespace fpc
