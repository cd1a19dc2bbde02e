// A plant from a lambda and the integrator's parameters, for tests.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "plant/integrator.hpp"

namespace fpc {
namespace integrator_fixture {

using Equations = std::function<void(VectorRef, VectorRef, VectorRef, Eigen::Ref<Vector>)>;

/// A plant from a lambda: n states, one input, one disturbance.
class TestPlant final : public Plant {
 public:
  TestPlant(int n, double time_unit_s, Equations equations) : equations_(std::move(equations)) {
    for (int i = 0; i < n; ++i)
      description_.states.push_back({"x" + std::to_string(i), "-", 0.0, -1e9, 1e9});
    description_.inputs = {{"u", "-", 0.0, -1e9, 1e9}};
    description_.disturbances = {{"d", "-", 0.0, -1e9, 1e9}};
    description_.time_unit_s = time_unit_s;
  }
  const PlantDescription& description() const override { return description_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    equations_(x, u, d, dxdt);
  }

 private:
  PlantDescription description_;
  Equations equations_;
};

inline const Vector kZero = Vector::Zero(1);

constexpr IntegrationMethod kBdf = IntegrationMethod::kBdf, kAdams = IntegrationMethod::kAdams,
                            kRungeKutta = IntegrationMethod::kRungeKutta;

inline IntegratorParams with(IntegrationMethod method, double tolerance = 1e-8) {
  IntegratorParams params;
  params.method = method;
  params.relative_tolerance = tolerance;
  params.absolute_tolerance = tolerance;
  return params;
}

inline void firstOrder(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
  dxdt = u + d - x;
}

}  // namespace integrator_fixture
}  // namespace fpc
