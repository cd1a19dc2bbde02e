// Least squares of any smooth function inside linear limits, by sequential quadratic programming:
// Gauss-Newton steps, damped (levenberg1944, marquardt1963), each a QP with the limits.
#pragma once

#include <functional>

#include "optim/qp.hpp"

namespace fpc {

/// Writes r(x), m numbers; returns false where it is not defined.
using Residuals = std::function<bool(VectorRef x, Eigen::Ref<Vector> r)>;

/// x_lower <= x <= x_upper,  a_lower <= A x <= a_upper. Infinite bounds are absent.
struct LinearLimits {
  Vector x_lower, x_upper;
  Matrix A;
  Vector a_lower, a_upper;
};

struct GaussNewtonSettings {
  int max_iterations{30};   ///< steps tried
  double tolerance{1e-9};   ///< a step that is shorter (largest element) is the last one
  double difference{1e-6};  ///< of the central differences, absolute: scale x to about 1
  void validate() const;    ///< @throws InputError naming the field
};

struct GaussNewtonResult {
  SolveStatus status{SolveStatus::kNumericalError};
  Vector x;       ///< the best point, always inside the limits
  double cost{};  ///< |r(x)|^2
  int iterations{};
  /// A point to be used: the best one found also where the iterations ended the search.
  bool usable() const {
    return status == SolveStatus::kSolved || status == SolveStatus::kIterationLimit;
  }
};

/// No allocation in solve(). Never throws there; r is asked inside the bounds only, though beside
/// the rows by `difference`.
class GaussNewton {
 public:
  /// n unknowns, m residuals, `rows` linear rows. @throws InputError on sizes and settings.
  GaussNewton(Eigen::Index n, Eigen::Index m, Eigen::Index rows,
              const GaussNewtonSettings& settings = {});
  /// Minimises |r(x)|^2 from `start`, which must lie inside the limits. kInvalidProblem: r is not
  /// defined there.
  const GaussNewtonResult& solve(const Residuals& r, VectorRef start, const LinearLimits& limits);

 private:
  bool differentiate(const Residuals& r, const LinearLimits& limits);
  const QpResult& proposeStep(const LinearLimits& limits, double damping);

  GaussNewtonSettings settings_;
  GaussNewtonResult result_;
  QpProblem qp_;
  QpSolver solver_;
  Vector r_, trial_, trial_r_, below_, rows_;
  Matrix J_;
};

}  // namespace fpc
