// What measured disturbances will probably be: as they were a period (a day) ago, with today's
// difference dying out.
#pragma once

#include "fmbpc/base/types.hpp"

namespace fpc {

/// d(k+i) = d(k+i-P) + pole^i (d(k) - d(k-P)), from past measurements only; until a period has been
/// seen, and without one (P = 0), d(k) is held. Source: the seasonal naive forecast with an error
/// of first order, boxjenkins1970, chapter 9. With a memory the forecast is trusted as far
/// as it was right lately: d(k) + w (forecast - d(k)), w in [0, 1] of each disturbance from the
/// squared errors of forecasts made half a horizon ago and those of holding d, both fading over
/// memory_steps: w = 1 while the forecasts err no more, 0 where they err kUseless times as much,
/// linear between. An event that does not come again weighs as much as it was large. No allocation
/// after construction.
class DisturbanceForecast {
 public:
  /// @throws InputError unless 0 <= period_steps and 0 <= pole <= 1, or if a period is shorter than
  /// the horizon it is to be known over.
  DisturbanceForecast(Eigen::Index n_d, int horizon_steps, int period_steps, double pole,
                      int memory_steps = 0);
  void forget();
  /// Element i is d(k+i), NaN where it is not known; after the last one as there. At sample k it
  /// goes before what is forecast here.
  void expect(std::uint32_t k, Eigen::Index disturbance, VectorRef ahead);
  /// d of sample `step`; samples that were missed are taken to be like it.
  void add(std::uint32_t step, VectorRef disturbances);
  /// n_d horizon_steps, column i = d(k+i).
  const Matrix& predict();
  const Vector& weight() const { return weight_; }  ///< n_d, w
  static constexpr double kUseless = 2.0;           ///< squared errors over those of holding d

 private:
  Eigen::Index column(std::uint32_t step) const;
  void learn();

  Matrix past_, future_;  ///< past_: d of sample k in column k mod its columns
  Matrix expected_;       ///< as future_; NaN: not known
  std::uint32_t expected_step_{};
  bool expects_{};  ///< expected_ holds something, of that sample
  Vector weight_;
  Vector error_, held_error_;  ///< faded sums of squares, of the forecast and of holding
  double fading_{1.0};         ///< of the squares, per sample; 1: w stays 1
  Eigen::Index lead_{};        ///< samples ahead at which w is judged
  Eigen::Index period_;
  double pole_;
  std::uint32_t last_step_{};
  Eigen::Index known_{};  ///< samples in past_
};

}  // namespace fpc
