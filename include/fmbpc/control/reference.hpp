// Reference trajectories: first-order paths from the present output to the setpoint.
#pragma once

#include "fmbpc/base/types.hpp"
#include "fmbpc/control/setpoint_source.hpp"

namespace fpc {

/// y_r(k+1) = a_r y_r(k) + (1 - a_r) setpoint(k), y_r(0) = y(0). With preview it is setpoint(k+1):
/// a path without lag (a_r = 0) changes with the setpoint, not a sample after it. Source:
/// vallejo2019, eqs. 29, 30, 37.
class ReferenceTrajectory {
 public:
  /// pole: n_y values a_r in [0, 1). With preview the future setpoints come from the schedule and
  /// the commands now in force (a command yet to come is not known), otherwise the present one is
  /// held over the horizon.
  ReferenceTrajectory(Vector pole, bool preview);
  void reset(VectorRef outputs);                    ///< y_r = y
  void goOnFrom(const ReferenceTrajectory& other);  ///< of as many outputs
  /// Draws y_r(k) to within reach (n_y, > 0, infinity: any distance) of the outputs. Whether it was
  /// farther from one.
  bool holdBack(VectorRef outputs, const Vector& reach);
  const Vector& present() const { return present_; }  ///< y_r(k)
  const Vector& asked() const { return asked_; }      ///< y_r(k), had nothing been held back
  /// future.col(i) = y_r(k+1+i) for the columns from `first` on; the others are left as they are.
  /// Without preview those far off cost nothing. No memory touched, no allocation.
  void predict(const SetpointSource& setpoint, std::uint32_t step, Eigen::Ref<Matrix> future,
               Eigen::Index first = 0) const;
  void advance(const SetpointSource& setpoint, std::uint32_t step);  ///< from k = step to k+1

 private:
  const Vector& target(const SetpointSource& setpoint, std::uint32_t step) const;
  void predictAhead(const SetpointSource& setpoint, std::uint32_t step, Eigen::Ref<Matrix> future,
                    Eigen::Index first) const;

  void follow(Vector& path, const Vector& aim) const;

  Vector pole_, present_, asked_;
  bool preview_;
  mutable Vector scheduled_, last_;
};

}  // namespace fpc
