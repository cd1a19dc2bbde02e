// Stability margins of a sampled loop from what it does after a pulse at an input, whatever law and
// plant are inside: S = 1 / (1 + L), L = 1 / S - 1. Source: astrom2008, section 9.3.
#pragma once

#include <complex>
#include <vector>

#include "fmbpc/base/types.hpp"

namespace fpc {

/// Of one input, the loops of the others closed.
struct LoopMargins {
  double gain_upper{};       ///< the loop gain may grow by this factor; infinite: by any
  double gain_lower{};       ///< and shrink to this; 0: to any
  double phase_deg{};        ///< smallest turn of L that makes it unstable, at most 180
  double delay_s{};          ///< smallest further dead time that does; infinite: none
  double crossover_rad_s{};  ///< highest frequency at which |L| = 1; 0: none
};

/// What the loop does after unit pulses at its inputs, one after the other.
class PulseResponse {
 public:
  /// `reached[j]` (n_u x n): what reaches the plant at each sample after a unit pulse at input j,
  /// the pulse included. @throws InputError on sizes.
  PulseResponse(std::vector<Matrix> reached, double sample_time_s);

  /// The last tenth of the samples is below `part` of the largest value.
  bool hasDecayed(double part = 1e-3) const;
  /// Of the swings in the second half of the samples, per sample: above 1 they grow.
  double growth() const;
  std::complex<double> loopGain(Eigen::Index input, double omega) const;  ///< L
  double peak() const;  ///< largest singular value of S
  LoopMargins margins(Eigen::Index input) const;
  /// From a cycle of all samples to two samples.
  const std::vector<double>& frequencies() const { return omega_; }  ///< [rad/s]

 private:
  Eigen::ArrayXcd transform(Eigen::Index from, Eigen::Index to, const Eigen::ArrayXd& omega) const;

  std::vector<Matrix> reached_;
  double sample_time_;
  std::vector<double> omega_;
};

}  // namespace fpc
