// The stirred-tank reactor of blazic2007: rest, branches, compensator, disturbance.
#include <gtest/gtest.h>

#include "analysis/steady_state.hpp"
#include "plant/simulation.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_cstr_test {

constexpr double kSampleTime = 6.0;  // [s]

SimulationParams reactorParams(double compensator_gain, double delay_s = 0.0) {
  SimulationParams p;
  p.plant = "cstr";
  p.parameters["compensator_gain"] = compensator_gain;
  p.initial_state = Eigen::Vector2d(0.1000001680476245, 438.5443805030675);
  p.outputs = {"CA"};
  p.output_delay_s = {delay_s};
  p.integrator.relative_tolerance = p.integrator.absolute_tolerance = 1e-10;
  p.actuator.limits = {one(0.0), one(200.0), one(std::numeric_limits<double>::infinity())};
  p.actuator.initial = p.actuator.fallback = one(103.4066);
  p.disturbance_nominal = Vector::Zero(2);
  p.sample_time_s = kSampleTime;
  p.samples = 2000;
  return p;
}

SteadyState rest(double q_c, const Vector& start) {
  const auto plant = makePlant("cstr");
  const auto f = [&](VectorRef x, VectorRef u, VectorRef d, Eigen::Ref<Vector> dxdt) {
    plant->derivatives(x, u, d, dxdt);
  };
  return findSteadyState(f, start, one(q_c), Vector::Zero(2));
}

TEST(Cstr, NominalSteadyState) {
  const SteadyState nominal = rest(103.4066, Eigen::Vector2d(0.1, 438.54));
  ASSERT_TRUE(nominal.ok());
  EXPECT_NEAR(nominal.x[0], 0.1, 1e-5);
  EXPECT_NEAR(nominal.x[1], 438.54, 0.005);
}

TEST(Cstr, HasThreeSteadyStatesBetweenItsFolds) {
  const SteadyState hot = rest(103.4066, Eigen::Vector2d(0.1, 438.0));
  const SteadyState middle = rest(103.4066, Eigen::Vector2d(0.5, 398.0));
  const SteadyState cold = rest(103.4066, Eigen::Vector2d(0.97, 353.0));
  ASSERT_TRUE(hot.ok() && middle.ok() && cold.ok());
  EXPECT_LT(hot.x[0] + 0.1, middle.x[0]);
  EXPECT_LT(middle.x[0] + 0.1, cold.x[0]);
}

TEST(Cstr, StaysAtRestWithTheCompensatorOn) {
  Simulation reactor(reactorParams(3.0, 30.0));
  for (int k = 0; k < 400; ++k) reactor.advance(one(103.4066));
  EXPECT_NEAR(reactor.measurement().outputs[0], 0.1, 1e-6);
  EXPECT_EQ(reactor.trouble(), "");
}

// q_applied(k) = u(k) + K [T(k) - T(k-1)], held one sample.
TEST(Cstr, CompensatorAddsItsShareOncePerSample) {
  Simulation reactor(reactorParams(3.0));
  SimulationParams plain_params = reactorParams(0.0);
  const auto plant = makePlant("cstr");
  Integrator cvode(*plant, plain_params.integrator);
  Vector x = plain_params.initial_state;
  double before = x[1];
  for (int k = 0; k < 50; ++k) {
    const double u = 103.4066 + (k < 20 ? 4.0 : -6.0);
    const double q_c = u + 3.0 * (x[1] - before);
    before = x[1];
    ASSERT_TRUE(cvode.advance(x, one(q_c), Vector::Zero(2), kSampleTime).ok());
    const Measurement& m = reactor.advance(one(u));
    ASSERT_EQ(reactor.state().state, x) << "sample " << k;
    EXPECT_EQ(m.input_applied[0], u) << "what the compensator adds is not the controller's input";
  }
}

TEST(Cstr, CompensatorIsForgottenByAReset) {
  Simulation reactor(reactorParams(3.0));
  reactor.advance(one(110.0));
  const Vector once = reactor.state().state;
  reactor.advance(one(110.0));
  reactor.reset(2);
  reactor.advance(one(110.0));
  EXPECT_EQ(reactor.state().state, once);
}

// Above the Hopf point of the plain reactor, below that of the compensated one.
TEST(Cstr, CompensatorSettlesWhatThePlainReactorDoesNot) {
  const double q_c = 114.0;
  const SteadyState held = rest(q_c, Eigen::Vector2d(0.15, 430.0));
  ASSERT_TRUE(held.ok());
  const auto deviationAfter = [&](double gain) {
    SimulationParams p = reactorParams(gain);
    p.initial_state = held.x + Eigen::Vector2d(1e-4, 0.0);
    p.actuator.initial = one(q_c);
    Simulation reactor(p);
    for (int k = 0; k < 300; ++k) reactor.advance(one(q_c));
    return (reactor.state().state - held.x).norm();
  };
  EXPECT_LT(deviationAfter(3.0), 1e-3);
  EXPECT_GT(deviationAfter(0.0), 0.1);
}

TEST(Cstr, CompensatorNeverAsksForANegativeFlow) {
  SimulationParams p = reactorParams(100.0);
  p.parameters["compensator_gain"] = 100.0;
  Simulation reactor(p);
  for (int k = 0; k < 60; ++k) {
    reactor.advance(one(k % 20 < 10 ? 0.0 : 200.0));
    ASSERT_TRUE(reactor.state().state.allFinite());
    ASSERT_EQ(reactor.trouble(), "") << "sample " << k;
  }
}

TEST(Cstr, HalfAMinuteOfSampleLineIsFiveSamples) {
  Simulation reactor(reactorParams(3.0, 30.0));
  std::vector<double> true_ca;
  for (int k = 0; k < 30; ++k) {
    true_ca.push_back(reactor.state().state[0]);
    const double expected = k < 5 ? true_ca.front() : true_ca[static_cast<std::size_t>(k - 5)];
    ASSERT_EQ(reactor.measurement().outputs[0], expected) << "sample " << k;
    reactor.advance(one(108.0));
  }
}

TEST(Cstr, InputDisturbanceActsLikeTheInputButIsNotSeenInIt) {
  SimulationParams with = reactorParams(3.0);
  Simulation shifted(with), moved(with);
  shifted.command({0, {"d_q_c"}, {3.0}, CommandMode::kOverride});
  shifted.advance(one(103.4066));
  moved.advance(one(103.4066));
  for (int k = 0; k < 30; ++k) {
    const Measurement& m = shifted.advance(one(103.4066));
    moved.advance(one(106.4066));
    ASSERT_NEAR(m.outputs[0], moved.measurement().outputs[0], 1e-9);
    ASSERT_EQ(m.input_applied[0], 103.4066);
  }
}

}  // namespace plant_cstr_test
}  // namespace fpc
