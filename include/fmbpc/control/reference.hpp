// Reference trajectories: first-order paths from the present output to the setpoint.
#pragma once

#include "fmbpc/base/types.hpp"
#include "fmbpc/control/setpoint_source.hpp"

namespace fpc {

/// y_r(k+1) = a_r y_r(k) + (1 - a_r) setpoint(k), y_r(0) = y(0). Source: Vallejo 2019 eqs. 29,
/// 30, 37.
class ReferenceTrajectory {
 public:
  /// pole: n_y values a_r in [0, 1). With preview the future setpoints come from the schedule,
  /// otherwise the present one is held over the horizon.
  ReferenceTrajectory(Vector pole, bool preview);
  void reset(VectorRef outputs);                      ///< y_r = y
  const Vector& present() const { return present_; }  ///< y_r(k)
  /// future.col(i) = y_r(k+1+i) for the columns given; no memory touched, no allocation.
  void predict(const SetpointSource& setpoint, std::uint32_t step, Eigen::Ref<Matrix> future) const;
  void advance(VectorRef setpoint);  ///< to k+1

 private:
  Vector pole_, present_;
  bool preview_;
  mutable Vector scheduled_;
};

}  // namespace fpc
