// One sample of a plant by SUNDIALS CVODE, inputs and disturbances held.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fmbpc/plant/plant.hpp"

namespace fpc {

/// kBdf: stiff, Newton, dense.
enum class IntegrationMethod { kBdf, kAdams };
inline std::vector<std::string> wordsOf(IntegrationMethod) { return {"bdf", "adams"}; }

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
  long steps{};
  bool ok() const { return status == IntegrationStatus::kOk; }
};

/// Restarts CVODE at each sample, so that advance() depends on its arguments only (bit for bit).
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
  struct Cvode;
  std::unique_ptr<Cvode> cvode_;
};

}  // namespace fpc
