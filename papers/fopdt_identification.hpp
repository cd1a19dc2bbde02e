// Lags with dead times from records, sample by sample: least squares on an over-parametrised
// numerator, then gain, time constant and a dead time that need not be whole samples. Source:
// mekki, eqs. 5-17 (after Bai and Zhang), with the sign of y in the regressor as it must be
// (+y(k-1) for A = 1 - a/z) and the rounding of the delay replaced by the exact inversion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fopdt.hpp"
#include "optim/rls.hpp"

namespace fpc {

/// From y(k+1) = a y(k) + sum_r b_r u(k+1-r): K = S / (1 - a), S = sum b, tau = -Ts / ln a. With
/// the centroid sum r b_r / S = 1 + d + w, 0 <= w < 1, a held input of dead time (d + f) Ts gives
/// f = 1 - ln(a + w (1 - a)) / ln a. Empty unless 0 < a < 1, S is not lost in rounding, and the
/// centroid is at least 1.
std::optional<Fopdt> recoverFopdt(double a, VectorRef b, double sample_time_min);
/// The same with the paper's eqs. 16 and 17, INT(centroid - 1/2) whole samples: half a sample off
/// and more. For comparison.
std::optional<Fopdt> recoverFopdtRounded(double a, VectorRef b, double sample_time_min);

/// kArx: measured y in the regressor; noise biases it whatever the amount of data. kOutputError:
/// the model's own output there (landau1976), unbiased; one input only, as 1/A - 1/2 must be
/// positive real, which a first-order A always is.
enum class MisoMethod { kArx, kOutputError };

struct MisoParams {
  int numerator_terms{
      10};          ///< m: b_1..b_m of each input; reaches dead times of m - n_u - 1 samples
  bool bias{true};  ///< a column of ones, for what no input explains
  RlsParams rls{1.0, 1e6, 1e8};
  MisoMethod method{MisoMethod::kArx};
  int warm_up_steps{60};         ///< kOutputError: so many samples by kArx first
  int quiet_steps{0};            ///< > 0: inputs that have not moved for so long teach nothing
  void validate(int n_u) const;  ///< @throws InputError naming the field
};

/// One measured output as the sum of n_u = 1 or 2 elements with a common denominator of order n_u:
///   A(z) y = sum_j B_j(z) u_j + c,  A = prod (1 - a_j / z),  B_j = (element j) prod_{i != j}.
/// n_u = 1 on the share of one input alone is the paper's access, which no plant offers.
class MisoEstimator {
 public:
  /// @throws InputError naming the field.
  MisoEstimator(int n_u, double sample_time_min, const MisoParams& params);
  /// u(k-1), held until now, and y(k). No allocation after construction. @return whether it was
  /// learned from: not before the numerator is filled, not when quiet or not finite.
  bool update(VectorRef input, double y);
  /// One per input; empty where nothing plausible can be read from the parameters.
  std::optional<Fopdt> element(int input) const;
  double gain(int input) const;  ///< steady gain B_j(1) / A(1), whatever the poles
  const Vector& theta() const { return rls_.theta(); }  ///< a's, then b's input by input, then c
  const RecursiveLeastSquares& leastSquares() const { return rls_; }

 private:
  Vector numerator(int input) const;
  bool moved(VectorRef input);
  void remember(VectorRef input);

  int n_u_;
  double sample_time_min_;
  MisoParams params_;
  RecursiveLeastSquares rls_;
  Vector regressor_, previous_;
  double model_output_{};
  int samples_{}, still_{};
  int unknown_{};  // samples over which a value that was not finite is still remembered
};

}  // namespace fpc
