// Gains of one output's elements, learned while the loop runs from what can be measured: the output
// as a whole, not the share of each input.
#pragma once

#include <array>

#include "base/fopdt.hpp"
#include "optim/rls.hpp"

namespace fpc {

struct GainEstimatorParams {
  double forgetting{0.98};           ///< of the least squares, (0, 1]
  double initial_covariance{100.0};  ///< of the ratios gain / nominal gain
  double covariance_bound{1e4};
  bool bias{true};  ///< a column that takes what no input explains (an unmeasured feed)
  double excitation_lower{0.0};  ///< output units: without this much movement nothing is learned
  void validate() const;         ///< @throws InputError naming the field
};

/// y(k) = sum_j K_j phi_j(k) + bias, phi_j the unit-gain answer of element j (its lag and dead time
/// are taken as known) to the inputs applied. The regressors are free of measurement noise, so
/// noise does not bias the gains. Parameters are ratios to the nominal gains, so their scale is 1.
class GainEstimator {
 public:
  /// @throws InputError naming the field.
  GainEstimator(const std::array<Fopdt, 2>& row, double sample_time_min,
                const GainEstimatorParams& params);
  /// The inputs have always been at these; what has been learned stays.
  void rest(double input_1, double input_2);
  void advance(double input_1, double input_2);  ///< inputs applied since the last sample
  /// Learns from y [deviation from rest]. No allocation. @return whether it did: false without
  /// excitation or for a value that is not finite.
  bool update(double y);
  /// Back to these gains, with the initial uncertainty.
  void restart(double gain_1, double gain_2);

  double gain(std::size_t j) const { return row_[j].gain * rls_.theta()[index(j)]; }
  /// Relative standard deviation of a gain: sqrt of its variance over the nominal gain.
  double deviation(std::size_t j) const;
  double bias() const { return params_.bias ? rls_.theta()[2] : 0.0; }
  /// Largest distance of a modelled share from its own recent mean, output units.
  double excitation() const { return excitation_; }

 private:
  static Eigen::Index index(std::size_t j) { return static_cast<Eigen::Index>(j); }

  std::array<Fopdt, 2> row_;
  GainEstimatorParams params_;
  std::array<LagResponse, 2> responses_;
  std::array<double, 2> mean_{};  // of each share, with the window of the forgetting
  double excitation_{}, error_variance_{}, weight_{};
  Vector theta_0_, regressor_;
  RecursiveLeastSquares rls_;
};

}  // namespace fpc
