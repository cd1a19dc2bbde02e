// What measured disturbances will probably be: as they were a period (a day) ago, with today's
// difference dying out.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// d(k+i) = d(k+i-P) + pole^i (d(k) - d(k-P)), from past measurements only; until a period has been
/// seen, and without one (P = 0), d(k) is held. Source: the seasonal naive forecast with an error
/// of first order, Box and Jenkins 1976, chapter 9. No allocation after construction.
class DisturbanceForecast {
 public:
  /// @throws InputError unless 0 <= period_steps and 0 <= pole <= 1, or if a period is shorter than
  /// the horizon it is to be known over.
  DisturbanceForecast(Eigen::Index n_d, int horizon_steps, int period_steps, double pole);
  void forget();
  /// d of sample `step`; samples that were missed are taken to be like it.
  void add(std::uint32_t step, VectorRef disturbances);
  /// n_d horizon_steps, column i = d(k+i).
  const Matrix& predict();

 private:
  Eigen::Index column(std::uint32_t step) const;

  Matrix past_, future_;  ///< past_: d of sample k in column k mod (P+1)
  Eigen::Index period_;
  double pole_;
  std::uint32_t last_step_{};
  Eigen::Index known_{};  ///< samples in past_
};

}  // namespace fpc
