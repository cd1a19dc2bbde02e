// CVODE's multistep methods behind a function call (hindmarsh2005).
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "plant/sundials.hpp"
#if SUNDIALS_VERSION_MAJOR >= 4
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#else
#include <cvode/cvode_direct.h>
#endif

namespace fpc {
namespace {

static_assert(CV_SUCCESS == kSundialsDone && CV_TOO_MUCH_WORK == kTooMuchWorkFlag &&
              CV_RHSFUNC_FAIL == kFirstModelFlag && CV_UNREC_RHSFUNC_ERR == kLastModelFlag);

#if SUNDIALS_VERSION_MAJOR < 4
using SUNNonlinearSolver = void*;  // CVODE 3 holds its iteration itself
#endif

class Cvode final : public SundialsMethod {
 public:
  using SundialsMethod::SundialsMethod;
  ~Cvode() override;
  void create(const IntegratorParams& params);

 private:
  int move(Real t_end) override;
  long steps() const override;
  bool chooseSolver(bool stiff);

  SUNMatrix matrix_{};
  SUNLinearSolver linear_solver_{};
  SUNNonlinearSolver nonlinear_solver_{};
  void* memory_{};
};

void Cvode::create(const IntegratorParams& params) {
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
                  CVodeSetUserData(memory_, static_cast<SundialsMethod*>(this)) == CV_SUCCESS &&
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
}

int Cvode::move(Real t_end) {
  int flag = CVodeReInit(memory_, 0.0, y_);
  if (flag == CV_SUCCESS) flag = CVodeSetStopTime(memory_, t_end);
  Real t = 0.0;
  if (flag == CV_SUCCESS) flag = CVode(memory_, t_end, y_, &t, CV_NORMAL);
  return flag;
}

long Cvode::steps() const {
  long steps = 0;
  CVodeGetNumSteps(memory_, &steps);
  return steps;
}

}  // namespace

std::unique_ptr<SundialsMethod> makeCvode(const Plant& plant, const IntegratorParams& params) {
  auto method = std::make_unique<Cvode>(plant);
  method->create(params);
  return method;
}

}  // namespace fpc
