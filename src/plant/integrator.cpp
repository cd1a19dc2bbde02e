// CVODE behind a function call (hindmarsh2005, SUNDIALS). The only file that knows
// SUNDIALS; its interface changed at 4 (nonlinear solvers), 6 (contexts) and 7 (error handlers),
// which the few switches below follow.
#include "fmbpc/plant/integrator.hpp"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#if SUNDIALS_VERSION_MAJOR >= 4
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#else
#include <cvode/cvode_direct.h>
#endif

#include <cmath>
#include <stdexcept>

#include "fmbpc/base/input_error.hpp"

namespace fpc {

#if SUNDIALS_VERSION_MAJOR >= 6
using Real = sunrealtype;
#define FPC_CONTEXT , context
#else
using Real = realtype;
#define FPC_CONTEXT
#endif
#if SUNDIALS_VERSION_MAJOR < 4
using SUNNonlinearSolver = void*;  // CVODE 3 holds its iteration itself
#endif
static_assert(sizeof(Real) == sizeof(double), "SUNDIALS must be built with double precision");

void IntegratorParams::validate() const {
  require(relative_tolerance > 0.0 && relative_tolerance < 1.0, "integrator.relative_tolerance",
          "a number > 0 and < 1");
  require(absolute_tolerance > 0.0 && std::isfinite(absolute_tolerance),
          "integrator.absolute_tolerance", "a finite number > 0");
  require(max_steps >= 1, "integrator.max_steps", "an integer >= 1");
}

/// Owns all SUNDIALS objects and what the C callbacks see; never moves in memory.
struct Integrator::Cvode {
  Cvode(const Plant& plant, const IntegratorParams& params);
  ~Cvode();
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;

  void create(const IntegratorParams& params);
  bool chooseSolver(bool stiff);
  void free();
  void silence();
  int integrate(VectorRef x, double t_end);
  IntegrationResult explain(int flag) const;
  static int derivatives(Real t, N_Vector y, N_Vector ydot, void* self);

  const Plant& plant;
  Eigen::Index n;
  Vector u, d;
  std::string model_error, solver_error;
#if SUNDIALS_VERSION_MAJOR >= 6
  SUNContext context{};
#endif
  N_Vector y{};
  SUNMatrix matrix{};
  SUNLinearSolver linear_solver{};
  SUNNonlinearSolver nonlinear_solver{};
  void* memory{};
};

namespace {

[[noreturn]] void failCreation() {
  throw std::runtime_error("integrator: CVODE could not be set up");
}

#if SUNDIALS_VERSION_MAJOR >= 7
void collectError(int, const char*, const char*, const char* message, SUNErrCode, void* text,
                  SUNContext) {
  *static_cast<std::string*>(text) = message != nullptr ? message : "";
}
#else
void collectError(int, const char*, const char*, char* message, void* text) {
  *static_cast<std::string*>(text) = message != nullptr ? message : "";
}
#endif

}  // namespace

Integrator::Cvode::Cvode(const Plant& p, const IntegratorParams& params)
    : plant(p),
      n(static_cast<Eigen::Index>(p.description().states.size())),
      u(static_cast<Eigen::Index>(p.description().inputs.size())),
      d(static_cast<Eigen::Index>(p.description().disturbances.size())) {
  params.validate();
  try {
    create(params);
  } catch (...) {
    free();
    throw;
  }
}

Integrator::Cvode::~Cvode() { free(); }

void Integrator::Cvode::create(const IntegratorParams& params) {
  const bool stiff = params.method == IntegrationMethod::kBdf;
#if SUNDIALS_VERSION_MAJOR >= 7
  if (SUNContext_Create(SUN_COMM_NULL, &context) != 0) failCreation();
#elif SUNDIALS_VERSION_MAJOR == 6
  if (SUNContext_Create(nullptr, &context) != 0) failCreation();
#endif
  y = N_VNew_Serial(static_cast<sunindextype>(n) FPC_CONTEXT);
#if SUNDIALS_VERSION_MAJOR >= 4
  memory = CVodeCreate(stiff ? CV_BDF : CV_ADAMS FPC_CONTEXT);
#else
  memory = stiff ? CVodeCreate(CV_BDF, CV_NEWTON) : CVodeCreate(CV_ADAMS, CV_FUNCTIONAL);
#endif
  if (y == nullptr || memory == nullptr) failCreation();
  silence();
  N_VConst(0.0, y);
  const bool ok = CVodeInit(memory, &Cvode::derivatives, 0.0, y) == CV_SUCCESS &&
                  CVodeSStolerances(memory, params.relative_tolerance, params.absolute_tolerance) ==
                      CV_SUCCESS &&
                  CVodeSetUserData(memory, this) == CV_SUCCESS &&
                  CVodeSetMaxNumSteps(memory, params.max_steps) == CV_SUCCESS &&
                  CVodeSetMaxHnilWarns(memory, -1) == CV_SUCCESS;
  if (!ok || !chooseSolver(stiff)) failCreation();
}

/// Newton with a dense matrix for stiff plants, else functional (fixed-point) iteration.
bool Integrator::Cvode::chooseSolver(bool stiff) {
  const auto size = static_cast<sunindextype>(n);
  if (stiff) matrix = SUNDenseMatrix(size, size FPC_CONTEXT);
#if SUNDIALS_VERSION_MAJOR >= 4
  if (stiff) {
    linear_solver = SUNLinSol_Dense(y, matrix FPC_CONTEXT);
    return CVodeSetLinearSolver(memory, linear_solver, matrix) == CV_SUCCESS;
  }
  nonlinear_solver = SUNNonlinSol_FixedPoint(y, 0 FPC_CONTEXT);
  return CVodeSetNonlinearSolver(memory, nonlinear_solver) == CV_SUCCESS;
#else
  if (!stiff) return true;
  linear_solver = SUNDenseLinearSolver(y, matrix);
  return CVDlsSetLinearSolver(memory, linear_solver, matrix) == CV_SUCCESS;
#endif
}

void Integrator::Cvode::free() {
  if (memory != nullptr) CVodeFree(&memory);
#if SUNDIALS_VERSION_MAJOR >= 4
  if (nonlinear_solver != nullptr) SUNNonlinSolFree(nonlinear_solver);
#endif
  if (linear_solver != nullptr) SUNLinSolFree(linear_solver);
  if (matrix != nullptr) SUNMatDestroy(matrix);
  if (y != nullptr) N_VDestroy(y);
#if SUNDIALS_VERSION_MAJOR >= 6
  if (context != nullptr) SUNContext_Free(&context);
#endif
}

/// CVODE would print on stderr; its words belong into the result.
void Integrator::Cvode::silence() {
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_ClearErrHandlers(context);
  SUNContext_PushErrHandler(context, collectError, &solver_error);
#else
  CVodeSetErrHandlerFn(memory, collectError, &solver_error);
#endif
}

int Integrator::Cvode::derivatives(Real, N_Vector y, N_Vector ydot, void* self) {
  auto& cvode = *static_cast<Cvode*>(self);
  try {
    const Eigen::Map<const Vector> x(NV_DATA_S(y), cvode.n);
    Eigen::Map<Vector> dxdt(NV_DATA_S(ydot), cvode.n);
    cvode.plant.derivatives(x, cvode.u, cvode.d, dxdt);
    if (dxdt.allFinite()) return 0;
    cvode.model_error = "derivatives are not finite";
    return 1;  // recoverable: a shorter step may stay inside the model's range
  } catch (const std::exception& e) {
    cvode.model_error = e.what();
  } catch (...) {
    cvode.model_error = "unknown exception";
  }
  return -1;
}

int Integrator::Cvode::integrate(VectorRef x, double t_end) {
  model_error.clear();
  solver_error.clear();
  Eigen::Map<Vector>(NV_DATA_S(y), n) = x;
  int flag = CVodeReInit(memory, 0.0, y);
  if (flag == CV_SUCCESS) flag = CVodeSetStopTime(memory, t_end);
  Real t = 0.0;
  if (flag == CV_SUCCESS) flag = CVode(memory, t_end, y, &t, CV_NORMAL);
  return flag;
}

IntegrationResult Integrator::Cvode::explain(int flag) const {
  IntegrationResult result;
  const bool model = flag == CV_RHSFUNC_FAIL || flag == CV_FIRST_RHSFUNC_ERR ||
                     flag == CV_REPTD_RHSFUNC_ERR || flag == CV_UNREC_RHSFUNC_ERR;
  if (model) {
    result.status = IntegrationStatus::kModelFailed;
    result.reason = "the plant's equations failed: " + model_error;
  } else if (flag == CV_TOO_MUCH_WORK) {
    result.status = IntegrationStatus::kTooMuchWork;
    result.reason = "more integration steps than integrator.max_steps";
  } else {
    result.reason = "CVODE error " + std::to_string(flag) + ": " + solver_error;
    if (!model_error.empty()) result.reason += " (" + model_error + ")";
  }
  return result;
}

Integrator::Integrator(const Plant& plant, const IntegratorParams& params)
    : cvode_(std::make_unique<Cvode>(plant, params)) {}
Integrator::~Integrator() = default;
Integrator::Integrator(Integrator&&) noexcept = default;

IntegrationResult Integrator::advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d,
                                      double seconds) {
  Cvode& c = *cvode_;
  require(x.size() == c.n, "integrator: x", "one element per state of the plant");
  require(u.size() == c.u.size(), "integrator: u", "one element per input of the plant");
  require(d.size() == c.d.size(), "integrator: d", "one element per disturbance of the plant");
  require(std::isfinite(seconds) && seconds >= 0.0, "integrator: seconds", "a finite time >= 0");
  IntegrationResult result;
  if (!x.allFinite() || !u.allFinite() || !d.allFinite()) {
    result.status = IntegrationStatus::kModelFailed;
    result.reason = "a state, input or disturbance is not finite";
    return result;
  }
  c.u = u;
  c.d = d;
  const double t_end = seconds / c.plant.description().time_unit_s;
  const int flag = t_end > 0.0 ? c.integrate(x, t_end) : CV_SUCCESS;
  if (flag < 0) result = c.explain(flag);
  if (t_end > 0.0) CVodeGetNumSteps(c.memory, &result.steps);
  if (flag < 0) return result;
  if (t_end > 0.0) {
    const Eigen::Map<const Vector> moved(NV_DATA_S(c.y), c.n);
    if (!moved.allFinite()) {
      result.reason = "the integrated state is not finite";
      return result;
    }
    x = moved;
  }
  result.status = IntegrationStatus::kOk;
  return result;
}

}  // namespace fpc
