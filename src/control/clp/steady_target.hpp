// The steady state at which a local model would hold chosen outputs at their setpoints.
#pragma once

#include <vector>

#include <Eigen/LU>

#include "fmbpc/base/exchange.hpp"
#include "fmbpc/base/types.hpp"

namespace fpc {

/// [A - I, B; C_t, 0] [x_ss; u_ss] = [-g; setpoint_t - offset_output_t]: integrators need no
/// inverse of A - I. Allocates at construction only.
class SteadyTarget {
 public:
  /// `outputs`: indices of the n_u outputs that define the steady state.
  SteadyTarget(Eigen::Index n_x, Eigen::Index n_u, std::vector<int> outputs);
  /// False if the steady state is not unique or not finite.
  bool solve(const PredictiveAction& now);
  const Vector& state() const { return state_; }  ///< x_ss
  const Vector& input() const { return input_; }  ///< u_ss

 private:
  std::vector<int> outputs_;
  Matrix system_;
  Eigen::FullPivLU<Matrix> factors_;
  Vector right_side_, solution_, state_, input_;
};

}  // namespace fpc
