// A plant of somebody else's whose own stepper can fail: the simulation asks it by the contract.
#include <gtest/gtest.h>

#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_stepper_failure_test {

/// x(k+1) = x(k) + u(k); says that it failed beyond 2.
class CountingStepper final : public PlantStepper {
 public:
  void reset(VectorRef, VectorRef) override { failure_.clear(); }
  void advance(Eigen::Ref<Vector> x, VectorRef u, VectorRef) override {
    x[0] += u[0];
    failure_ = x[0] > 2.0 ? "the counter overflows" : "";
  }
  std::string failure() const override { return failure_; }

 private:
  std::string failure_;
};

class Counter final : public Plant {
 public:
  Counter() {
    about_.name = "test_counter";
    about_.title = "It counts up to 2";
    about_.states = {{"x", "1", 0.0, -10.0, 10.0}};
    about_.inputs = {{"u", "1", 0.0, -10.0, 10.0}};
    about_.outputs = {"x"};
  }
  const PlantDescription& description() const override { return about_; }
  void derivatives(VectorRef, VectorRef u, VectorRef, Eigen::Ref<Vector> dxdt) const override {
    dxdt = u;
  }
  std::unique_ptr<PlantStepper> makeStepper(double) const override {
    return std::make_unique<CountingStepper>();
  }

 private:
  PlantDescription about_;
};

SimulationParams counterParams() {
  static const bool registered = registerPlant(
      "test_counter", [](const PlantParameters&) { return std::make_unique<Counter>(); });
  EXPECT_TRUE(registered);
  SimulationParams p;
  p.plant = "test_counter";
  p.initial_state = one(0.0);
  p.actuator.limits = {one(-10.0), one(10.0), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = one(0.0);
  p.disturbance_nominal = Vector(0);
  p.samples = 10;
  return p;
}

TEST(StepperFailure, HoldsTheStateAndIsToldInItsWords) {
  Simulation simulation(counterParams());
  for (int k = 0; k < 2; ++k) simulation.advance(one(1.0));
  EXPECT_EQ(simulation.trouble(), "");
  EXPECT_EQ(simulation.measurement().outputs, one(2.0));
  simulation.advance(one(1.0));
  EXPECT_EQ(simulation.trouble(), "sample 2: the counter overflows");
  EXPECT_EQ(simulation.state().trouble, simulation.trouble());
  EXPECT_EQ(simulation.measurement().outputs, one(2.0));
  EXPECT_EQ(simulation.measurement().input_applied, one(1.0));
}

TEST(StepperFailure, IsOverWhenAStepSucceeds) {
  Simulation simulation(counterParams());
  simulation.advance(one(3.0));
  EXPECT_EQ(simulation.state().trouble, "sample 0: the counter overflows");
  simulation.advance(one(2.0));
  EXPECT_EQ(simulation.state().trouble, "");
  EXPECT_EQ(simulation.measurement().outputs, one(2.0));
}

TEST(StepperFailure, AStepperThatKnowsOfNoneNeverFails) {
  const auto tank = makePlant("surge_tank");
  const auto stepper = tank->makeStepper(1.0);
  ASSERT_NE(stepper, nullptr);
  EXPECT_EQ(stepper->failure(), "");
}

}  // namespace plant_stepper_failure_test
}  // namespace fpc
