// The surge tank of taieb2017: rest, drainage, the pump that cannot reverse, Euler step.
#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "plant/simulation.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_surge_tank_test {

constexpr double kStep = 0.1;                          // [s]
const double kOutflow = 6e-5 * std::sqrt(2.0 * 9.81);  // [m2.5/s], times the root of H - Hs

SimulationParams tankParams(double level, double current) {
  SimulationParams p;
  p.plant = "surge_tank";
  p.initial_state = Eigen::Vector2d(level, 0.1 * current);
  p.actuator.limits = {one(0.0), one(0.03), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = one(current);
  p.disturbance_nominal = one(0.0);
  p.integrator.relative_tolerance = 1e-10;
  p.integrator.absolute_tolerance = 1e-14;
  p.sample_time_s = kStep;
  p.samples = 100000;
  return p;
}

Vector rates(double level, double flow, double current, double feed = 0.0) {
  Vector dxdt(2);
  makePlant("surge_tank")->derivatives(Eigen::Vector2d(level, flow), one(current), one(feed), dxdt);
  return dxdt;
}

TEST(SurgeTank, RestsAtFifteenCentimetresWithTheFlowOfItsOutlet) {
  const Vector dxdt = rates(0.15, 9.765e-5, 9.765e-4);
  EXPECT_NEAR(dxdt[0] * 0.04, 0.0, 5e-9) << "[m3/s]";
  EXPECT_NEAR(dxdt[1], 0.0, 1e-15);
}

TEST(SurgeTank, StaysAtRest) {
  const double flow = kOutflow * std::sqrt(0.135);
  for (const double step : {0.1, 0.0}) {
    SimulationParams p = tankParams(0.15, 10.0 * flow);
    p.parameters["difference_step"] = step;
    Simulation tank(p);
    for (int k = 0; k < 600; ++k) tank.advance(one(10.0 * flow));
    EXPECT_NEAR(tank.measurement().outputs[0], 0.15, 1e-10) << "step " << step;
  }
}

TEST(SurgeTank, NothingFlowsOutBelowTheOutlet) {
  EXPECT_EQ(rates(0.015, 0.0, 0.0)[0], 0.0);
  EXPECT_EQ(rates(0.01, 0.0, 0.0)[0], 0.0);
  EXPECT_NEAR(rates(0.01, 2e-5, 2e-4)[0], 2e-5 / 0.04, 1e-18);
}

// sqrt(h) falls linearly: t = 2 A (sqrt(h0) - sqrt(h1)) / (0.6 a sqrt(2 g)), h = H - Hs.
TEST(SurgeTank, DrainsInTorricellisTime) {
  SimulationParams p = tankParams(0.295, 0.0);
  p.initial_state[1] = 0.0;
  p.parameters["difference_step"] = 0.0;
  p.integrator.relative_tolerance = 1e-12;
  Simulation tank(p);
  const double seconds = 2.0 * 0.04 * (std::sqrt(0.28) - std::sqrt(0.24)) / kOutflow;
  EXPECT_NEAR(seconds, 11.82, 0.005);
  for (int k = 0; k < 118; ++k) tank.advance(one(0.0));
  const double root = std::sqrt(0.28) - 11.8 * kOutflow / 0.08;
  EXPECT_NEAR(tank.measurement().outputs[0], 0.015 + root * root, 1e-9);
}

TEST(SurgeTank, MovesByTheEulerStepOfThePaper) {
  Simulation tank(tankParams(0.2, 1e-3));
  double H = 0.2, Q = 1e-4;
  for (int k = 0; k < 200; ++k) {
    const double I = k % 40 < 20 ? 4e-3 : 0.0;
    const double outflow = kOutflow * std::sqrt(H - 0.015);
    H += kStep / 0.04 * (Q - outflow);
    Q += kStep * (-Q + 0.1 * I);
    tank.advance(one(I));
    ASSERT_NEAR(tank.state().state[0], H, 1e-13) << "sample " << k;
    ASSERT_NEAR(tank.state().state[1], Q, 1e-16) << "sample " << k;
  }
}

TEST(SurgeTank, ACurrentMovesTheLevelAfterTwoSamples) {
  Simulation moved(tankParams(0.2, 1e-3)), still(tankParams(0.2, 1e-3));
  moved.advance(one(2e-3));
  still.advance(one(1e-3));
  EXPECT_EQ(moved.measurement().outputs[0], still.measurement().outputs[0]);
  moved.advance(one(1e-3));
  still.advance(one(1e-3));
  EXPECT_NEAR(moved.measurement().outputs[0] - still.measurement().outputs[0], 2.5e-5, 1e-12);
}

// Level gained = (what the pump brought - what flowed out) / A, to the last drop.
TEST(SurgeTank, KeepsItsWater) {
  Simulation tank(tankParams(0.2, 1e-3));
  tank.command({0, {"q_f"}, {3e-5}, CommandMode::kOverride});
  double volume = 0.04 * 0.2;
  for (int k = 0; k < 300; ++k) {
    const Vector x = tank.state().state;
    const double feed = k > 0 ? 3e-5 : 0.0;  // the command acts from the next sample on
    volume += kStep * (x[1] + feed - kOutflow * std::sqrt(x[0] - 0.015));
    tank.advance(one(k < 100 ? 2e-3 : 0.0));
    ASSERT_NEAR(0.04 * tank.state().state[0], volume, 1e-15) << "sample " << k;
  }
}

TEST(SurgeTank, ThePumpNeverReverses) {
  EXPECT_EQ(rates(0.2, 0.0, -5e-3)[1], 0.0) << "a negative current is none";
  SimulationParams p = tankParams(0.02, 0.0);
  Simulation tank(p);
  tank.command({0, {"q_f"}, {-1e-4}, CommandMode::kOverride});
  for (int k = 0; k < 400; ++k) {
    tank.advance(one(k < 10 ? 0.03 : 0.0));
    ASSERT_GE(tank.state().state[1], 0.0) << "sample " << k;
    ASSERT_GE(tank.state().state[0], 0.0) << "sample " << k;
  }
}

TEST(SurgeTank, TheContinuousTankIsNearItsEulerStep) {
  SimulationParams p = tankParams(0.15, 9.765e-4);
  Simulation euler(p);
  p.parameters["difference_step"] = 0.0;
  Simulation exact(p);
  for (int k = 0; k < 300; ++k) {
    euler.advance(one(3e-3));
    exact.advance(one(3e-3));
  }
  EXPECT_NEAR(euler.measurement().outputs[0], exact.measurement().outputs[0], 5e-4);
  EXPECT_GT(exact.measurement().outputs[0], 0.2);
}

TEST(SurgeTank, AnEulerStepMustBeAPartOfTheSampleTime) {
  SimulationParams p = tankParams(0.15, 1e-3);
  p.sample_time_s = 0.25;
  EXPECT_THROW(Simulation{p}, InputError);
  p.sample_time_s = 0.3;
  EXPECT_NO_THROW(Simulation{p});
  p.parameters["difference_step"] = 2.0;
  EXPECT_THROW(Simulation{p}, InputError) << "would make the pump swing";
}

}  // namespace plant_surge_tank_test
}  // namespace fpc
