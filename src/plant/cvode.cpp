// CVODE's multistep methods behind a function call (hindmarsh2005). Its interface changed at 4
// (nonlinear solvers), 6 (contexts) and 7 (error handlers), which the few switches follow.
#include <cstdio>  // FILE, which the vector's header takes for granted in SUNDIALS 3

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <stdexcept>

#include "plant/sample_method.hpp"
#if SUNDIALS_VERSION_MAJOR >= 4
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#else
#include <cvode/cvode_direct.h>
#endif

#if SUNDIALS_VERSION_MAJOR >= 6
#define FPC_CONTEXT , context_
#else
#define FPC_CONTEXT
#endif

namespace fpc {
namespace {

#if SUNDIALS_VERSION_MAJOR >= 6
using Real = sunrealtype;
#else
using Real = realtype;
#endif
static_assert(sizeof(Real) == sizeof(double), "SUNDIALS must be built with double precision");
static_assert(CV_RHSFUNC_FAIL == -8 && CV_UNREC_RHSFUNC_ERR == -11, "flags of the equations");

#if SUNDIALS_VERSION_MAJOR < 4
using SUNNonlinearSolver = void*;  // CVODE 3 holds its iteration itself
#endif

/// Owns SUNDIALS objects and what their C callbacks see.
class Cvode final : public SampleMethod {
 public:
  using SampleMethod::SampleMethod;
  ~Cvode() override;
  void create(const IntegratorParams& params);

 private:
  IntegrationResult move(double time) override;
  void makeVector();
  bool chooseSolver(bool stiff);
  int moveVector(Real t_end);
  IntegrationResult explain(int flag) const;
  static int derivatives(Real t, N_Vector y, N_Vector ydot, void* self);
  [[noreturn]] static void failCreation();

  std::string solver_error_;
#if SUNDIALS_VERSION_MAJOR >= 6
  SUNContext context_{};
#endif
  N_Vector y_{};
  SUNMatrix matrix_{};
  SUNLinearSolver linear_solver_{};
  SUNNonlinearSolver nonlinear_solver_{};
  void* memory_{};
};

// SUNDIALS would print on stderr; its words belong into the result.
#if SUNDIALS_VERSION_MAJOR >= 7
void collectError(int, const char*, const char*, const char* message, SUNErrCode, void* text,
                  SUNContext) {
#else
void collectError(int, const char*, const char*, char* message, void* text) {
#endif
  *static_cast<std::string*>(text) = message != nullptr ? message : "";
}

void Cvode::failCreation() { throw std::runtime_error("integrator: SUNDIALS could not be set up"); }

void Cvode::makeVector() {
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &context_) != 0) failCreation();
  SUNContext_ClearErrHandlers(context_);
  SUNContext_PushErrHandler(context_, collectError, &solver_error_);
#elif SUNDIALS_VERSION_MAJOR == 6
  if (SUNContext_Create(nullptr, &context_) != 0) failCreation();
#endif
  y_ = N_VNew_Serial(static_cast<sunindextype>(n_) FPC_CONTEXT);
  if (y_ == nullptr) failCreation();
  N_VConst(0.0, y_);
}

void Cvode::create(const IntegratorParams& params) {
  makeVector();
  const bool stiff = params.method == IntegrationMethod::kBdf;
#if SUNDIALS_VERSION_MAJOR >= 4
  memory_ = CVodeCreate(stiff ? CV_BDF : CV_ADAMS FPC_CONTEXT);
#else
  memory_ = stiff ? CVodeCreate(CV_BDF, CV_NEWTON) : CVodeCreate(CV_ADAMS, CV_FUNCTIONAL);
#endif
  if (memory_ == nullptr) failCreation();
#if SUNDIALS_VERSION_MAJOR < 7
  CVodeSetErrHandlerFn(memory_, collectError, &solver_error_);
#endif
  const bool ok = CVodeInit(memory_, derivatives, 0.0, y_) == CV_SUCCESS &&
                  CVodeSStolerances(memory_, params.relative_tolerance,
                                    params.absolute_tolerance) == CV_SUCCESS &&
                  CVodeSetUserData(memory_, this) == CV_SUCCESS &&
                  CVodeSetMaxNumSteps(memory_, params.max_steps) == CV_SUCCESS &&
                  CVodeSetMaxHnilWarns(memory_, -1) == CV_SUCCESS;
  if (!ok || !chooseSolver(stiff)) failCreation();
}

/// Newton with a dense matrix for stiff plants, else functional (fixed-point) iteration.
bool Cvode::chooseSolver(bool stiff) {
  const auto size = static_cast<sunindextype>(n_);
  if (stiff) matrix_ = SUNDenseMatrix(size, size FPC_CONTEXT);
#if SUNDIALS_VERSION_MAJOR >= 4
  if (stiff) {
    linear_solver_ = SUNLinSol_Dense(y_, matrix_ FPC_CONTEXT);
    return CVodeSetLinearSolver(memory_, linear_solver_, matrix_) == CV_SUCCESS;
  }
  nonlinear_solver_ = SUNNonlinSol_FixedPoint(y_, 0 FPC_CONTEXT);
  return CVodeSetNonlinearSolver(memory_, nonlinear_solver_) == CV_SUCCESS;
#else
  if (!stiff) return true;
  linear_solver_ = SUNDenseLinearSolver(y_, matrix_);
  return CVDlsSetLinearSolver(memory_, linear_solver_, matrix_) == CV_SUCCESS;
#endif
}

Cvode::~Cvode() {
  if (memory_ != nullptr) CVodeFree(&memory_);
#if SUNDIALS_VERSION_MAJOR >= 4
  if (nonlinear_solver_ != nullptr) SUNNonlinSolFree(nonlinear_solver_);
#endif
  if (linear_solver_ != nullptr) SUNLinSolFree(linear_solver_);
  if (matrix_ != nullptr) SUNMatDestroy(matrix_);
  if (y_ != nullptr) N_VDestroy(y_);
#if SUNDIALS_VERSION_MAJOR >= 6
  if (context_ != nullptr) SUNContext_Free(&context_);
#endif
}

int Cvode::derivatives(Real, N_Vector y, N_Vector ydot, void* self) {
  switch (static_cast<Cvode*>(self)->evaluate(NV_DATA_S(y), NV_DATA_S(ydot))) {
    case Equations::kFinite:
      return 0;
    case Equations::kNotFinite:
      return 1;  // recoverable: a shorter step of CVODE may stay inside the model's range
    default:
      return -1;
  }
}

IntegrationResult Cvode::explain(int flag) const {
  IntegrationResult result;
  if (flag <= CV_RHSFUNC_FAIL && flag >= CV_UNREC_RHSFUNC_ERR) {
    result.status = IntegrationStatus::kModelFailed;
    result.reason = "the plant's equations failed: " + model_error_;
  } else if (flag == CV_TOO_MUCH_WORK) {
    result.status = IntegrationStatus::kTooMuchWork;
    result.reason = "more integration steps than integrator.max_steps";
  } else {
    result.reason = "SUNDIALS error " + std::to_string(flag) + ": " + solver_error_;
  }
  if (result.status != IntegrationStatus::kModelFailed && !model_error_.empty())
    result.reason += " (" + model_error_ + ")";
  return result;
}

IntegrationResult Cvode::move(double time) {
  solver_error_.clear();
  Eigen::Map<Vector> y(NV_DATA_S(y_), n_);
  y = state_;
  const int flag = moveVector(time);
  IntegrationResult result;
  if (flag < 0) {
    result = explain(flag);
  } else {
    result.status = IntegrationStatus::kOk;
    state_ = y;
  }
  CVodeGetNumSteps(memory_, &result.steps);
  return result;
}

int Cvode::moveVector(Real t_end) {
  int flag = CVodeReInit(memory_, 0.0, y_);
  if (flag == CV_SUCCESS) flag = CVodeSetStopTime(memory_, t_end);
  Real t = 0.0;
  if (flag == CV_SUCCESS) flag = CVode(memory_, t_end, y_, &t, CV_NORMAL);
  return flag;
}

}  // namespace

std::unique_ptr<SampleMethod> makeCvode(const Plant& plant, const IntegratorParams& params) {
  auto method = std::make_unique<Cvode>(plant);
  method->create(params);
  return method;
}

}  // namespace fpc
