// What every integrator does around its own method: checks, the equations behind a wall, the state
// that stays where it was after a failure. Private to the room.
#pragma once

#include <memory>
#include <string>

#include "plant/integrator.hpp"

namespace fpc {

/// Never moves in memory: SUNDIALS' callbacks point to it.
class SampleMethod {
 public:
  explicit SampleMethod(const Plant& plant);
  virtual ~SampleMethod() = default;
  SampleMethod(const SampleMethod&) = delete;
  SampleMethod& operator=(const SampleMethod&) = delete;

  /// Moves x over `time` in the plant's unit; x is unchanged when the result is not ok.
  /// @throws InputError for a wrong size.
  IntegrationResult advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef d, double time);
  double timeUnit() const { return plant_.description().time_unit_s; }

 protected:
  enum class Equations { kFinite, kNotFinite, kThrew };

  /// Moves state_, which holds x(0), by time > 0. Depends on state_, u, d and time only.
  virtual IntegrationResult move(double time) = 0;
  /// dx/dt [n] at x [n]; never throws, words of a failure go into model_error_.
  Equations evaluate(const double* x, double* dxdt) noexcept;

  Eigen::Index n_;
  Vector state_;
  std::string model_error_;

 private:
  const Plant& plant_;
  Vector u_, d_;
};

std::unique_ptr<SampleMethod> makeCvode(const Plant& plant, const IntegratorParams& params);
std::unique_ptr<SampleMethod> makeRungeKutta(const Plant& plant, const IntegratorParams& params);

}  // namespace fpc
