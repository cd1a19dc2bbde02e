#include "plant/integrator.hpp"

#include <cmath>
#include <stdexcept>

#include "fmbpc/base/input_error.hpp"
#include "plant/sample_method.hpp"

namespace fpc {

void IntegratorParams::validate() const {
  require(relative_tolerance > 0.0 && relative_tolerance < 1.0, "integrator.relative_tolerance",
          "a number > 0 and < 1");
  require(absolute_tolerance > 0.0 && std::isfinite(absolute_tolerance),
          "integrator.absolute_tolerance", "a finite number > 0");
  require(max_steps >= 1, "integrator.max_steps", "an integer >= 1");
}

SampleMethod::SampleMethod(const Plant& plant)
    : n_(static_cast<Eigen::Index>(plant.description().states.size())),
      state_(n_),
      plant_(plant),
      u_(static_cast<Eigen::Index>(plant.description().inputs.size())),
      d_(static_cast<Eigen::Index>(plant.description().disturbances.size())) {}

SampleMethod::Equations SampleMethod::evaluate(const double* x, double* dxdt) noexcept {
  try {
    Eigen::Map<Vector> slope(dxdt, n_);
    plant_.derivatives(Eigen::Map<const Vector>(x, n_), u_, d_, slope);
    if (slope.allFinite()) return Equations::kFinite;
    model_error_ = "derivatives are not finite";
    return Equations::kNotFinite;
  } catch (const std::exception& e) {
    model_error_ = e.what();
  } catch (...) {
    model_error_ = "unknown exception";
  }
  return Equations::kThrew;
}

IntegrationResult SampleMethod::advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d,
                                        double time) {
  require(x.size() == n_, "integrator: x", "one element per state of the plant");
  require(u.size() == u_.size(), "integrator: u", "one element per input of the plant");
  require(d.size() == d_.size(), "integrator: d", "one element per disturbance of the plant");
  require(std::isfinite(time) && time >= 0.0, "integrator: seconds", "a finite time >= 0");
  IntegrationResult result;
  if (!x.allFinite() || !u.allFinite() || !d.allFinite()) {
    result.status = IntegrationStatus::kModelFailed;
    result.reason = "a state, input or disturbance is not finite";
    return result;
  }
  result.status = IntegrationStatus::kOk;
  if (time == 0.0) return result;
  u_ = u;
  d_ = d;
  model_error_.clear();
  state_ = x;
  result = move(time);
  if (!result.ok()) return result;
  if (state_.allFinite()) {
    x = state_;
  } else {
    result.status = IntegrationStatus::kSolverFailed;
    result.reason = "the integrated state is not finite";
  }
  return result;
}

Integrator::Integrator(const Plant& plant, const IntegratorParams& params) {
  params.validate();
  method_ = params.method == IntegrationMethod::kRungeKutta ? makeRungeKutta(plant, params)
                                                            : makeCvode(plant, params);
}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator&&) noexcept = default;

IntegrationResult Integrator::advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d,
                                      double seconds) {
  return method_->advance(x, u, d, seconds / method_->timeUnit());
}

}  // namespace fpc
