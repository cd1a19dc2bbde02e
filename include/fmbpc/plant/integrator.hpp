// One sample of a plant by SUNDIALS (CVODE or ARKODE), inputs and disturbances held.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// kBdf: stiff, Newton, dense. kRungeKutta: explicit, orders 5 and 4; one-step, so that it loses
/// nothing by starting anew at each sample.
enum class IntegrationMethod { kBdf, kAdams, kRungeKutta };
inline std::vector<std::string> wordsOf(IntegrationMethod) {
  return {"bdf", "adams", "runge_kutta"};
}
/// Whether this build has kRungeKutta: SUNDIALS 4 or newer with ARKODE.
bool hasRungeKutta();

struct IntegratorParams {
  double relative_tolerance{1e-8};
  double absolute_tolerance{1e-8};
  int max_steps{5000};
  IntegrationMethod method{IntegrationMethod::kBdf};
  /// @throws InputError naming the field, also for a method that the build has not.
  void validate(bool has_runge_kutta = hasRungeKutta()) const;
};

enum class IntegrationStatus { kOk, kTooMuchWork, kModelFailed, kSolverFailed };

struct IntegrationResult {
  IntegrationStatus status{IntegrationStatus::kSolverFailed};
  std::string reason;  ///< words for a person, empty when ok
  long steps{};
  bool ok() const { return status == IntegrationStatus::kOk; }
};

class SundialsMethod;  // private to the room

/// Starts anew at each sample, so that advance() depends on its arguments only (bit for bit).
class Integrator {
 public:
  /// Keeps a reference to `plant`.
  Integrator(const Plant& plant, const IntegratorParams& params);
  ~Integrator();
  Integrator(Integrator&&) noexcept;

  /// Moves x over `seconds`; x is unchanged when the result is not ok. Model exceptions become
  /// kModelFailed.
  IntegrationResult advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d, double seconds);

 private:
  std::unique_ptr<SundialsMethod> method_;
};

}  // namespace fpc
