#include "analysis/steady_state.hpp"

#include <Eigen/LU>
#include <cmath>
#include <exception>
#include <limits>

#include "fmbpc/base/input_error.hpp"

namespace fpc {
namespace {

constexpr double kJacobianStep =
    6e-6;                           // cube root of the rounding error: best for central differences
constexpr double kSingular = 1e-9;  // pivots below this part of the largest are rounding
constexpr double kShortestDamping = 1e-6;

class Newton {
 public:
  Newton(const Derivative& f, VectorRef start, VectorRef u, VectorRef d,
         const SteadyStateParams& params)
      : f_(f), u_(u), d_(d), params_(params), start_(start), jacobian_(start.size(), start.size()) {
    result_.x = start;
    value_.resize(start.size());
  }

  SteadyState solve() {
    result_.status = run();
    result_.residual = value_.cwiseAbs().maxCoeff();
    return result_;
  }

 private:
  SteadyStateStatus run();
  bool evaluate(const Vector& x, Vector& value) const;
  bool computeJacobian();
  bool factor();
  Vector stepFor(const Vector& value) const;
  double size(const Vector& step) const { return (step.array() / scale_.array()).abs().maxCoeff(); }
  bool takeStep(const Vector& step, double length);

  const Derivative& f_;
  Vector u_, d_;
  SteadyStateParams params_;
  Vector start_, value_, scale_, rows_;
  Matrix jacobian_;
  Eigen::FullPivLU<Matrix> factors_;
  SteadyState result_;
};

bool Newton::evaluate(const Vector& x, Vector& value) const {
  try {
    f_(x, u_, d_, value);
  } catch (const std::exception&) {
    return false;
  }
  return value.allFinite();
}

/// With respect to scaled states, so that pivots can be compared.
bool Newton::computeJacobian() {
  const Eigen::Index n = result_.x.size();
  Vector x = result_.x, ahead(n), behind(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const double h = kJacobianStep * scale_[j];
    x[j] = result_.x[j] + h;
    if (!evaluate(x, ahead)) return false;
    x[j] = result_.x[j] - h;
    if (!evaluate(x, behind)) return false;
    x[j] = result_.x[j];
    jacobian_.col(j) = (ahead - behind) / (2.0 * kJacobianStep);
  }
  return true;
}

/// False if the Jacobian has no inverse.
bool Newton::factor() {
  rows_ = jacobian_.cwiseAbs().rowwise().maxCoeff();
  if (rows_.minCoeff() == 0.0) return false;
  factors_.compute(rows_.cwiseInverse().asDiagonal() * jacobian_);
  factors_.setThreshold(kSingular);
  return factors_.isInvertible();
}

Vector Newton::stepFor(const Vector& value) const {
  return scale_.asDiagonal() * factors_.solve(-value.cwiseQuotient(rows_));
}

/// Shortens the step until the simplified Newton step behind it is shorter than the step itself.
bool Newton::takeStep(const Vector& step, double length) {
  Vector value(step.size());
  for (double damping = 1.0; damping >= kShortestDamping; damping *= 0.5) {
    const Vector x = result_.x + damping * step;
    if (!evaluate(x, value)) continue;
    if (size(stepFor(value)) > (1.0 - 0.25 * damping) * length &&
        damping * length > params_.tolerance)
      continue;
    result_.x = x;
    value_ = value;
    return true;
  }
  return false;
}

SteadyStateStatus Newton::run() {
  if (!evaluate(result_.x, value_)) {
    value_.setConstant(std::numeric_limits<double>::infinity());
    return SteadyStateStatus::kModelFailed;
  }
  for (; result_.iterations < params_.max_iterations; ++result_.iterations) {
    scale_ = result_.x.cwiseAbs().cwiseMax(start_.cwiseAbs()).cwiseMax(params_.state_floor);
    if (!computeJacobian()) return SteadyStateStatus::kModelFailed;
    if (!factor()) return SteadyStateStatus::kSingular;
    const Vector step = stepFor(value_);
    const double length = size(step);
    if (!takeStep(step, length)) return SteadyStateStatus::kStuck;
    if (length <= params_.tolerance) return SteadyStateStatus::kSolved;
  }
  return SteadyStateStatus::kIterationLimit;
}

}  // namespace

void SteadyStateParams::validate() const {
  require(tolerance > 0.0 && tolerance < 1.0, "tolerance", "a number > 0 and < 1");
  require(state_floor > 0.0 && std::isfinite(state_floor), "state_floor", "a finite number > 0");
  require(max_iterations >= 1, "max_iterations", "an integer >= 1");
}

SteadyState findSteadyState(const Derivative& f, VectorRef start, VectorRef u, VectorRef d,
                            const SteadyStateParams& params) {
  params.validate();
  require(start.size() > 0 && start.allFinite(), "start", "finite numbers, one per state");
  return Newton(f, start, u, d, params).solve();
}

}  // namespace fpc
