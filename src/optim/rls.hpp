// Weighted recursive least squares with forgetting and a bounded covariance, for models that learn
// while they run.
#pragma once

#include <cstdint>

#include "fmbpc/base/types.hpp"

namespace fpc {

struct RlsParams {
  double forgetting{1.0};  ///< (0, 1]; 1 keeps all data alike
  double initial_covariance{
      1e6};  ///< > 0: P(0) = this times the identity; its inverse weighs the initial guess
  double covariance_bound{1e8};  ///< >= initial_covariance: no variance of P ever exceeds it
  void validate() const;         ///< @throws InputError naming the field
};

/// Minimises sum_t f^(T-t) w_t (y_t - theta' x_t)^2 + f^T (theta - theta_0)' P(0)^-1 (theta -
/// theta_0), one sample at a time. P = S S' is kept as its square root S (Potter's form), so it
/// stays positive semidefinite whatever the rounding. Scale the columns of x to about 1: the bound
/// is one number for all of them. Source: astrom1995, sec. 2.2;
/// Potter's update: bierman1977, sec. V.3.
class RecursiveLeastSquares {
 public:
  /// @throws InputError naming the field.
  RecursiveLeastSquares(const Vector& theta_0, const RlsParams& params);
  /// Takes one sample; `weight` in [0, 1] (a rule's firing weight) also scales how much is
  /// forgotten, so that a rule that does not fire keeps what it knows. No allocation. Samples that
  /// are not finite or weigh nothing are skipped.
  /// @return false if skipped.
  bool update(VectorRef x, double y, double weight = 1.0);
  void reset(VectorRef theta_0);
  const Vector& theta() const { return theta_; }
  Matrix covariance() const { return root_ * root_.transpose(); }
  /// P(i, i), without allocation.
  double variance(Eigen::Index i) const { return root_.row(i).squaredNorm(); }
  std::uint64_t skipped() const { return skipped_; }  ///< samples that were not finite
  std::uint64_t bounded() const { return bounded_; }  ///< updates in which the bound acted

 private:
  void boundCovariance();

  RlsParams params_;
  Vector theta_, projected_, gain_;
  Matrix root_;
  std::uint64_t skipped_{}, bounded_{};
};

}  // namespace fpc
