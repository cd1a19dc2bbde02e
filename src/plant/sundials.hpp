// What the integrators of SUNDIALS (hindmarsh2005) have in common: vector, context, callbacks and
// the reasons of a failure. Its interface changed at 4 (nonlinear solvers), 6 (contexts) and 7
// (error handlers), which the few switches follow. Only for the files that hold an integrator.
#pragma once

#include <cstdio>  // FILE, which the vector's header takes for granted in SUNDIALS 3

#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>

#include <memory>
#include <string>

#include "fmbpc/plant/integrator.hpp"

#if SUNDIALS_VERSION_MAJOR >= 6
#define FPC_CONTEXT , context_
#else
#define FPC_CONTEXT
#endif

namespace fpc {

#if SUNDIALS_VERSION_MAJOR >= 6
using Real = sunrealtype;
#else
using Real = realtype;
#endif
static_assert(sizeof(Real) == sizeof(double), "SUNDIALS must be built with double precision");

/// Flags that CVODE and ARKODE share; those of the equations lie between the last two.
constexpr int kSundialsDone = 0, kTooMuchWorkFlag = -1, kFirstModelFlag = -8, kLastModelFlag = -11;

/// Owns SUNDIALS objects and what their C callbacks see; never moves in memory.
class SundialsMethod {
 public:
  explicit SundialsMethod(const Plant& plant);
  virtual ~SundialsMethod();
  SundialsMethod(const SundialsMethod&) = delete;
  SundialsMethod& operator=(const SundialsMethod&) = delete;

  /// Moves x over `time` in the plant's unit; x is unchanged when the result is not ok.
  /// @throws InputError for a wrong size.
  IntegrationResult advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d, double time);
  double timeUnit() const { return plant_.description().time_unit_s; }

 protected:
  /// Moves y_, which holds x(0), to t_end; a flag of SUNDIALS.
  virtual int move(Real t_end) = 0;
  virtual long steps() const = 0;

  static int derivatives(Real t, N_Vector y, N_Vector ydot, void* self);
#if SUNDIALS_VERSION_MAJOR < 7
  static void collectError(int, const char*, const char*, char* message, void* text);
#endif
  [[noreturn]] static void failCreation();

  Eigen::Index n_;
  std::string solver_error_;
#if SUNDIALS_VERSION_MAJOR >= 6
  SUNContext context_{};
#endif
  N_Vector y_{};

 private:
  IntegrationResult explain(int flag) const;

  const Plant& plant_;
  Vector u_, d_;
  std::string model_error_;
};

std::unique_ptr<SundialsMethod> makeCvode(const Plant& plant, const IntegratorParams& params);
/// nullptr where the build has none.
std::unique_ptr<SundialsMethod> makeRungeKutta(const Plant& plant, const IntegratorParams& params);

}  // namespace fpc
