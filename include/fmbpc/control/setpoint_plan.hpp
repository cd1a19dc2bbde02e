// Setpoints that follow what is measured: an affine law above the controller, as plants set the
// ammonium of their effluent by load and flow.
//
//   setpoint_i += gain (s_1 s_2 ... / about - 1),   through a first-order lag
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct SetpointPlanTerm {
  Eigen::Index output{};                           ///< whose setpoint moves
  std::vector<Eigen::Index> outputs, disturbances;  ///< measured signals, multiplied
  double about{1.0};                               ///< their product at which the term is 0, not 0
  double gain{};                                   ///< of the output
  double lag_h{};                                  ///< time constant; 0: none
};

class SetpointPlan {
 public:
  SetpointPlan() = default;
  /// @throws InputError naming the field.
  SetpointPlan(std::vector<SetpointPlanTerm> terms, Eigen::Index n_y, double sample_time_h);

  bool empty() const { return terms_.empty(); }
  /// Forgets the lags: the next sample starts them where they would rest.
  void reset();
  /// What is added to the setpoints at this sample. Terms of signals that are not finite stay as
  /// they were. Steps increase; over skipped steps the lags catch up. No allocation.
  const Vector& follow(VectorRef outputs, VectorRef disturbances, std::uint32_t step);

 private:
  std::vector<SetpointPlanTerm> terms_;
  std::vector<double> value_;  // of each term behind its lag
  Vector sum_;                 // n_y
  double sample_time_h_{};
  std::uint32_t last_step_{};
  bool fresh_{true};
};

}  // namespace fpc
