// Measured outputs that are functions of states and input, and noise on disturbances.
#include <gtest/gtest.h>

#include "plant/simulation.hpp"

namespace fpc {
namespace plant_algebraic_output_test {

/// dx/dt = u + d - x; y = x^2 + 10 u.
class Squared final : public Plant {
 public:
  Squared() {
    about_.name = "squared";
    about_.title = "a test";
    about_.states = {{"x", "-", 0.0, -10.0, 10.0}};
    about_.algebraic = {{"y", "-", 0.0, -1e3, 1e3}};
    about_.inputs = {{"u", "-", 0.0, -5.0, 5.0}};
    about_.disturbances = {{"d", "-", 0.0, -1.0, 1.0}};
    about_.outputs = {"y"};
  }
  const PlantDescription& description() const override { return about_; }
  void derivatives(VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) const override {
    dxdt = u + d - x;
  }
  void algebraic(VectorRef x, VectorRef u, VectorRef, Eigen::Ref<Vector> y) const override {
    y[0] = x[0] * x[0] + 10.0 * u[0];
  }

 private:
  PlantDescription about_;
};

SimulationParams squared(std::vector<std::string> outputs) {
  SimulationParams p;
  p.factory = [](const PlantParameters&) { return std::make_unique<Squared>(); };
  p.outputs = std::move(outputs);
  const auto one = [](double v) { return Vector(Vector::Constant(1, v)); };
  p.initial_state = one(2.0);
  p.actuator.limits = {one(-5.0), one(5.0), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = one(1.0);
  p.disturbance_nominal = one(0.0);
  return p;
}

TEST(AlgebraicOutput, IsMeasuredUnderTheInputThatWasInForce) {
  Simulation plant(squared({"y", "x"}));
  EXPECT_EQ(plant.measurement().outputs, Eigen::Vector2d(14.0, 2.0));
  const Vector y = plant.advance(Vector::Constant(1, 3.0)).outputs;
  EXPECT_NEAR(y[1], 3.0 - std::exp(-1.0), 1e-6);
  EXPECT_NEAR(y[0], y[1] * y[1] + 30.0, 1e-12);
  EXPECT_EQ(plant.state().outputs, y);
  EXPECT_EQ(plant.info().outputs[0].upper, 1e3);
}

TEST(AlgebraicOutput, IsTheDefaultThatThePlantNames) {
  Simulation plant(squared({}));
  EXPECT_EQ(plant.info().outputs[0].name, "y");
}

TEST(DisturbanceNoise, IsWhiteAndOfTheSeed) {
  SimulationParams p = squared({"x"});
  p.disturbance_noise_std = Vector::Constant(1, 0.2);
  const auto disturbances = [](const SimulationParams& params) {
    Simulation plant(params);
    Vector d(4000);
    for (Eigen::Index k = 0; k < d.size(); ++k) {
      d[k] = plant.state().disturbances[0];
      plant.advance(Vector::Zero(1));
    }
    return d;
  };
  const Vector d = disturbances(p);
  EXPECT_NEAR(std::sqrt(d.squaredNorm() / 4000.0), 0.2, 0.01);
  EXPECT_NEAR(d.head(3999).dot(d.tail(3999)) / d.squaredNorm(), 0.0, 0.05);
  EXPECT_EQ(disturbances(p), d);
  p.noise_seed = 2;
  EXPECT_NE(disturbances(p), d);
}

/// The measurement's noise of a loop does not change because a disturbance has noise too.
TEST(DisturbanceNoise, LeavesTheMeasurementsNoiseAsItIs) {
  SimulationParams p = squared({"x"});
  p.noise_std = Vector::Constant(1, 0.1);
  const double before = Simulation(p).measurement().outputs[0];
  p.disturbance_noise_std = Vector::Constant(1, 0.2);
  EXPECT_EQ(Simulation(p).measurement().outputs[0], before);
}

}  // namespace plant_algebraic_output_test
}  // namespace fpc
