// ARKODE's explicit one-step methods behind a function call (hindmarsh2005): the pair of orders 5
// and 4 by Dormand and Prince. Its last stage is the first of the next step, which ARKODE before
// 6.7 takes to be so also of tables where it is not: another table would need a newer ARKODE.
#include "plant/sundials.hpp"
#if defined(FMBPC_ARKODE) && SUNDIALS_VERSION_MAJOR >= 4
#include <arkode/arkode_erkstep.h>
#endif

namespace fpc {

#if defined(FMBPC_ARKODE) && SUNDIALS_VERSION_MAJOR >= 4
namespace {

static_assert(ARK_SUCCESS == kSundialsDone && ARK_TOO_MUCH_WORK == kTooMuchWorkFlag &&
              ARK_RHSFUNC_FAIL == kFirstModelFlag && ARK_UNREC_RHSFUNC_ERR == kLastModelFlag);

// Since 7.1 the families of methods share these functions.
#if SUNDIALS_VERSION_MAJOR > 7 || (SUNDIALS_VERSION_MAJOR == 7 && SUNDIALS_VERSION_MINOR >= 1)
#define FPC_ARK(name) ARKode##name
constexpr auto setInterpolantDegree = ARKodeSetInterpolantDegree;
#else
#define FPC_ARK(name) ERKStep##name
constexpr auto setInterpolantDegree = ERKStepSetDenseOrder;
#endif
#if SUNDIALS_VERSION_MAJOR >= 6
constexpr auto kDormandPrince = ARKODE_DORMAND_PRINCE_7_4_5;
#else
constexpr int kDormandPrince = DORMAND_PRINCE_7_4_5;
#endif

class RungeKutta final : public SundialsMethod {
 public:
  using SundialsMethod::SundialsMethod;
  ~RungeKutta() override {
    if (memory_ != nullptr) FPC_ARK(Free)(&memory_);
  }
  void create(const IntegratorParams& params);

 private:
  /// The whole sample is tried as one step; should that lead out of the model's range or too far
  /// off, once more from a first step that ARKODE chooses, which is a short one.
  int move(Real t_end) override;
  int moveFrom(Real first_step, Real t_end);
  long steps() const override;

  void* memory_{};
  Vector start_;
};

void RungeKutta::create(const IntegratorParams& params) {
  memory_ = ERKStepCreate(derivatives, 0.0, y_ FPC_CONTEXT);
  if (memory_ == nullptr) failCreation();
#if SUNDIALS_VERSION_MAJOR < 7
  ERKStepSetErrHandlerFn(memory_, collectError, &solver_error_);
#endif
  const bool ok =
      FPC_ARK(SStolerances)(memory_, params.relative_tolerance, params.absolute_tolerance) ==
          ARK_SUCCESS &&
      FPC_ARK(SetUserData)(memory_, static_cast<SundialsMethod*>(this)) == ARK_SUCCESS &&
      FPC_ARK(SetMaxNumSteps)(memory_, params.max_steps) == ARK_SUCCESS &&
      FPC_ARK(SetMaxHnilWarns)(memory_, -1) == ARK_SUCCESS &&
      ERKStepSetTableNum(memory_, kDormandPrince) == ARK_SUCCESS &&
      // The last step ends at the sample: nothing is interpolated, no stage spent on it.
      setInterpolantDegree(memory_, 1) == ARK_SUCCESS;
  if (!ok) failCreation();
}

int RungeKutta::move(Real t_end) {
  Eigen::Map<Vector> y(NV_DATA_S(y_), n_);
  start_ = y;
  const int flag = moveFrom(t_end, t_end);
  if (flag >= 0 || flag == kTooMuchWorkFlag) return flag;
  y = start_;
  return moveFrom(0.0, t_end);
}

int RungeKutta::moveFrom(Real first_step, Real t_end) {
  int flag = ERKStepReInit(memory_, derivatives, 0.0, y_);
  if (flag == ARK_SUCCESS) flag = FPC_ARK(SetInitStep)(memory_, first_step);
  if (flag == ARK_SUCCESS) flag = FPC_ARK(SetStopTime)(memory_, t_end);
  Real t = 0.0;
  if (flag == ARK_SUCCESS) flag = FPC_ARK(Evolve)(memory_, t_end, y_, &t, ARK_NORMAL);
  return flag;
}

long RungeKutta::steps() const {
  long steps = 0;
  FPC_ARK(GetNumSteps)(memory_, &steps);
  return steps;
}

}  // namespace

bool hasRungeKutta() { return true; }
std::unique_ptr<SundialsMethod> makeRungeKutta(const Plant& plant, const IntegratorParams& params) {
  auto method = std::make_unique<RungeKutta>(plant);
  method->create(params);
  return method;
}
#else
bool hasRungeKutta() { return false; }
std::unique_ptr<SundialsMethod> makeRungeKutta(const Plant&, const IntegratorParams&) {
  return nullptr;
}
#endif

}  // namespace fpc
