#include "fmbpc/plant/integrator.hpp"

#include <cmath>
#include <stdexcept>

#include "fmbpc/base/input_error.hpp"
#include "plant/sundials.hpp"

namespace fpc {

void IntegratorParams::validate(bool has_runge_kutta) const {
  require(relative_tolerance > 0.0 && relative_tolerance < 1.0, "integrator.relative_tolerance",
          "a number > 0 and < 1");
  require(absolute_tolerance > 0.0 && std::isfinite(absolute_tolerance),
          "integrator.absolute_tolerance", "a finite number > 0");
  require(max_steps >= 1, "integrator.max_steps", "an integer >= 1");
  require(method != IntegrationMethod::kRungeKutta || has_runge_kutta, "integrator.method",
          "bdf or adams: runge_kutta needs SUNDIALS 4 or newer with ARKODE, which was not found "
          "when fmbpc was built");
}

namespace {

#if SUNDIALS_VERSION_MAJOR >= 7
void collectMessage(int, const char*, const char*, const char* message, SUNErrCode, void* text,
                    SUNContext) {
  *static_cast<std::string*>(text) = message != nullptr ? message : "";
}
#endif

}  // namespace

void SundialsMethod::failCreation() {
  throw std::runtime_error("integrator: SUNDIALS could not be set up");
}

// SUNDIALS would print on stderr; its words belong into the result.
SundialsMethod::SundialsMethod(const Plant& plant)
    : n_(static_cast<Eigen::Index>(plant.description().states.size())),
      plant_(plant),
      u_(static_cast<Eigen::Index>(plant.description().inputs.size())),
      d_(static_cast<Eigen::Index>(plant.description().disturbances.size())) {
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &context_) != 0) failCreation();
  SUNContext_ClearErrHandlers(context_);
  SUNContext_PushErrHandler(context_, collectMessage, &solver_error_);
#elif SUNDIALS_VERSION_MAJOR == 6
  if (SUNContext_Create(nullptr, &context_) != 0) failCreation();
#endif
  y_ = N_VNew_Serial(static_cast<sunindextype>(n_) FPC_CONTEXT);
  if (y_ == nullptr) failCreation();
  N_VConst(0.0, y_);
}

SundialsMethod::~SundialsMethod() {
  if (y_ != nullptr) N_VDestroy(y_);
#if SUNDIALS_VERSION_MAJOR >= 6
  if (context_ != nullptr) SUNContext_Free(&context_);
#endif
}

#if SUNDIALS_VERSION_MAJOR < 7
void SundialsMethod::collectError(int, const char*, const char*, char* message, void* text) {
  *static_cast<std::string*>(text) = message != nullptr ? message : "";
}
#endif

int SundialsMethod::derivatives(Real, N_Vector y, N_Vector ydot, void* self) {
  auto& method = *static_cast<SundialsMethod*>(self);
  try {
    const Eigen::Map<const Vector> x(NV_DATA_S(y), method.n_);
    Eigen::Map<Vector> dxdt(NV_DATA_S(ydot), method.n_);
    method.plant_.derivatives(x, method.u_, method.d_, dxdt);
    if (dxdt.allFinite()) return 0;
    method.model_error_ = "derivatives are not finite";
    return 1;  // recoverable: a shorter step of CVODE may stay inside the model's range
  } catch (const std::exception& e) {
    method.model_error_ = e.what();
  } catch (...) {
    method.model_error_ = "unknown exception";
  }
  return -1;
}

IntegrationResult SundialsMethod::explain(int flag) const {
  IntegrationResult result;
  if (flag <= kFirstModelFlag && flag >= kLastModelFlag) {
    result.status = IntegrationStatus::kModelFailed;
    result.reason = "the plant's equations failed: " + model_error_;
  } else if (flag == kTooMuchWorkFlag) {
    result.status = IntegrationStatus::kTooMuchWork;
    result.reason = "more integration steps than integrator.max_steps";
  } else {
    result.reason = "SUNDIALS error " + std::to_string(flag) + ": " + solver_error_;
  }
  if (result.status != IntegrationStatus::kModelFailed && !model_error_.empty())
    result.reason += " (" + model_error_ + ")";
  return result;
}

IntegrationResult SundialsMethod::advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d,
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
  solver_error_.clear();
  Eigen::Map<Vector> y(NV_DATA_S(y_), n_);
  y = x;
  const int flag = move(time);
  if (flag < 0) result = explain(flag);
  result.steps = steps();
  if (flag < 0) return result;
  if (y.allFinite()) {
    x = y;
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
