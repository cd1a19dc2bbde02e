// The explicit method: its order, its error on every plant, what it cannot do.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "plant/integrator_fixture.hpp"

namespace fpc {
namespace plant_runge_kutta_test {

using namespace integrator_fixture;

// dx/dt = 1e6 (1 - x): steps of the size that stability allows, until it says so.
TEST(RungeKutta, SaysThatAStiffPlantIsTooMuchWork) {
  const TestPlant plant(1, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt[0] = 1e6 * (1.0 - x[0]);
  });
  Integrator integrator(plant, with(kRungeKutta));
  Vector x = Vector::Zero(1);
  const IntegrationResult result = integrator.advance(x, kZero, kZero, 1.0);
  EXPECT_EQ(result.status, IntegrationStatus::kTooMuchWork) << result.reason;
  EXPECT_EQ(result.steps, with(kRungeKutta).max_steps);
  EXPECT_EQ(x[0], 0.0);
}

// A tank that drains, dx/dt = -x, with equations that hold above -0.1 only: a step over the whole
// sample leads below that and is tried again from a short one.
TEST(RungeKutta, AShortStepIsTriedWhereALongOneLeavesTheModel) {
  int refused = 0;
  const TestPlant plant(1, 1.0, [&](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    if (x[0] < -0.1) {
      ++refused;
      throw std::runtime_error("below the tank");
    }
    dxdt = -x;
  });
  Integrator integrator(plant, with(kRungeKutta));
  Vector x = Vector::Ones(1);
  const IntegrationResult result = integrator.advance(x, kZero, kZero, 10.0);
  EXPECT_TRUE(result.ok()) << result.reason;
  EXPECT_EQ(refused, 1);
  EXPECT_NEAR(x[0], std::exp(-10.0), 1e-6);
}

/// Steps and error over five turns of x'' = -x, whose x is the cosine.
std::pair<long, double> oscillate(double tolerance) {
  const TestPlant plant(2, 1.0, [](VectorRef x, VectorRef, VectorRef, Eigen::Ref<Vector> dxdt) {
    dxdt << x[1], -x[0];
  });
  Integrator integrator(plant, with(kRungeKutta, tolerance));
  Vector x = Eigen::Vector2d(1.0, 0.0);
  const IntegrationResult result = integrator.advance(x, kZero, kZero, 10.0 * M_PI);
  EXPECT_TRUE(result.ok()) << result.reason;
  return {result.steps, (x - Eigen::Vector2d(1.0, 0.0)).norm()};
}

// An error estimate of order 4 allows steps in proportion to tolerance^(1/5): 1e-5 of the tolerance
// costs ten times the steps (a pair of orders 3 and 2 would need 46 times, one of 8 and 7 four).
TEST(RungeKutta, IsOfOrdersFiveAndFour) {
  const auto loose = oscillate(1e-6), tight = oscillate(1e-11);
  EXPECT_LT(loose.second, 1e-4);
  EXPECT_LT(tight.second, 1e-9);
  const double growth = static_cast<double>(tight.first) / static_cast<double>(loose.first);
  EXPECT_GT(growth, 7.0);
  EXPECT_LT(growth, 14.0);
}

/// Somewhat off the values that the plant usually has.
Vector near(const std::vector<Quantity>& quantities, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> factor(0.8, 1.2);
  Vector values(static_cast<Eigen::Index>(quantities.size()));
  for (std::size_t i = 0; i < quantities.size(); ++i)
    values[static_cast<Eigen::Index>(i)] = quantities[i].nominal * factor(generator);
  return values;
}

// A sample by the explicit method, default tolerances, beside CVODE with narrow ones: the error
// adds up over the steps to less than a hundred tolerances. BSM1, which a loop file leaves to its
// own steps, has kinks that no error estimate sees.
TEST(RungeKutta, AgreesWithATightReferenceOnEveryPlant) {
  constexpr unsigned kSeed = 11;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  std::mt19937_64 generator(kSeed);
  for (const std::string& name : plantNames()) {
    SCOPED_TRACE(name);
    const auto plant = makePlant(name);
    const PlantDescription& about = plant->description();
    Integrator integrator(*plant, with(kRungeKutta)), reference(*plant, with(kBdf, 1e-12));
    if (about.states.size() > 50) continue;
    const double hold_s = std::min(0.2 * about.time_unit_s, 720.0);
    for (int i = 0; i < 50; ++i) {
      Vector x = near(about.states, generator), exact = x;
      const Vector u = near(about.inputs, generator), d = near(about.disturbances, generator);
      const IntegrationResult result = integrator.advance(x, u, d, hold_s);
      ASSERT_TRUE(result.ok()) << result.reason;
      ASSERT_TRUE(reference.advance(exact, u, d, hold_s).ok());
      const double error = ((x - exact).array().abs() / (1.0 + exact.array().abs())).maxCoeff();
      EXPECT_LT(error, 1e-6) << "trial " << i;
    }
  }
}

}  // namespace plant_runge_kutta_test
}  // namespace fpc
