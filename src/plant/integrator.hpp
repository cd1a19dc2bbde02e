// One sample of a plant by CVODE or an explicit method, inputs and disturbances held.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// kBdf: stiff, Newton, dense. kAdams: functional iteration. Both by CVODE. kRungeKutta: explicit,
/// orders 5 and 4; one-step, so that it loses nothing by starting anew at each sample.
enum class IntegrationMethod { kBdf, kAdams, kRungeKutta };
inline std::vector<std::string> wordsOf(IntegrationMethod) {
  return {"bdf", "adams", "runge_kutta"};
}

struct IntegratorParams {
  double relative_tolerance{1e-8};
  double absolute_tolerance{1e-8};
  int max_steps{5000};
  IntegrationMethod method{IntegrationMethod::kBdf};
  void validate() const;  ///< @throws InputError naming the field
};

enum class IntegrationStatus { kOk, kTooMuchWork, kModelFailed, kSolverFailed };

struct IntegrationResult {
  IntegrationStatus status{IntegrationStatus::kSolverFailed};
  std::string reason;  ///< words for a person, empty when ok
  long steps{};        ///< within the sample; of kRungeKutta with those refused
  bool ok() const { return status == IntegrationStatus::kOk; }
};

class SampleMethod;  // private to the room

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
  std::unique_ptr<SampleMethod> method_;
};

}  // namespace fpc
