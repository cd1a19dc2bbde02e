#include "optim/gauss_newton.hpp"

#include <algorithm>
#include <cmath>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

using Eigen::Index;

constexpr double kLeastDamping = 1e-10;  // relative to the largest curvature
constexpr double kMostDamping = 1e4;

}  // namespace

void GaussNewtonSettings::validate() const {
  require(max_iterations >= 1, "max_iterations", "an integer >= 1");
  require(std::isfinite(tolerance) && tolerance > 0.0, "tolerance", "a number > 0");
  require(std::isfinite(difference) && difference > 0.0, "difference", "a number > 0");
}

GaussNewton::GaussNewton(Index n, Index m, Index rows, const GaussNewtonSettings& settings)
    : settings_(settings),
      qp_(n, rows),
      solver_(n, rows),
      r_(m),
      trial_(n),
      trial_r_(m),
      below_(m),
      rows_(rows),
      J_(m, n) {
  settings_.validate();
  require(m >= 1, "residuals", "at least one");
  result_.x = Vector::Zero(n);
}

/// Central differences; one-sided where a bound is in the way.
bool GaussNewton::differentiate(const Residuals& r, const LinearLimits& limits) {
  trial_ = result_.x;
  for (Index j = 0; j < trial_.size(); ++j) {
    const double x = trial_[j];
    const double up = std::min(x + settings_.difference, limits.x_upper[j]);
    const double down = std::max(x - settings_.difference, limits.x_lower[j]);
    J_.col(j).setZero();
    if (!(up > down)) continue;  // fixed
    trial_[j] = up;
    if (!r(trial_, trial_r_)) return false;
    trial_[j] = down;
    if (!r(trial_, below_)) return false;
    trial_[j] = x;
    J_.col(j) = (trial_r_ - below_) / (up - down);
  }
  return J_.allFinite();
}

const QpResult& GaussNewton::proposeStep(const LinearLimits& limits, double damping) {
  qp_.H.noalias() = J_.transpose().lazyProduct(J_);
  const double largest = qp_.H.diagonal().maxCoeff();
  qp_.H.diagonal().array() += damping * (largest > 0.0 ? largest : 1.0);
  qp_.g.noalias() = J_.transpose().lazyProduct(r_);
  qp_.x_lower = limits.x_lower - result_.x;
  qp_.x_upper = limits.x_upper - result_.x;
  qp_.A = limits.A;
  rows_.noalias() = limits.A.lazyProduct(result_.x);
  // Round-off of the start must not make the rows impossible: a step of zero always fits.
  qp_.a_lower = (limits.a_lower - rows_).cwiseMin(0.0);
  qp_.a_upper = (limits.a_upper - rows_).cwiseMax(0.0);
  return solver_.solve(qp_);
}

const GaussNewtonResult& GaussNewton::solve(const Residuals& r, VectorRef start,
                                            const LinearLimits& limits) {
  solver_.forget();  // the answer depends on the arguments only
  result_.iterations = 0;
  result_.x = start.cwiseMax(limits.x_lower).cwiseMin(limits.x_upper);
  result_.status = SolveStatus::kInvalidProblem;
  if (!result_.x.allFinite() || !r(result_.x, r_)) return result_;
  result_.cost = r_.squaredNorm();
  result_.status = SolveStatus::kNumericalError;
  double damping = kLeastDamping;
  for (bool fresh = true; result_.iterations < settings_.max_iterations;) {
    if (fresh && !differentiate(r, limits)) return result_;
    ++result_.iterations;
    const QpResult& step = proposeStep(limits, damping);
    if (!step.usable()) return result_;
    result_.status = SolveStatus::kSolved;
    trial_ = (result_.x + step.x).cwiseMax(limits.x_lower).cwiseMin(limits.x_upper);
    if (step.x.lpNorm<Eigen::Infinity>() <= settings_.tolerance) {
      result_.x = trial_;  // the cost there is the same to rounding
      return result_;
    }
    fresh = r(trial_, trial_r_) && trial_r_.squaredNorm() < result_.cost;
    if (fresh) {
      result_.x = trial_;
      r_ = trial_r_;
      result_.cost = r_.squaredNorm();
      damping = std::max(kLeastDamping, 0.1 * damping);
    } else {
      damping = std::max(1e-4, 10.0 * damping);
      if (damping > kMostDamping) return result_;  // no step, however short, comes nearer
    }
  }
  result_.status = SolveStatus::kIterationLimit;
  return result_;
}

}  // namespace fpc
