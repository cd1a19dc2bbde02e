#include "plant/simulation.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "fmbpc/base/input_error.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_simulation_test {

TEST(Simulation, StartsWithSampleZero) {
  const Simulation simulation(sludgeParams());
  const Measurement& m = simulation.measurement();
  EXPECT_EQ(m.header.step, 0U);
  EXPECT_EQ(m.header.run_id, 1U);
  EXPECT_EQ(m.header.time_ns, 1'000'000'000);
  EXPECT_EQ(m.outputs, Eigen::Vector2d(200.0, 2000.0));
  EXPECT_EQ(m.disturbances, Eigen::Vector2d(1300.0, 366.67));
  EXPECT_EQ(m.input_applied, one(570.0));
  EXPECT_FALSE(m.final);
}

TEST(Simulation, TellsControllersWhatThePlantIs) {
  SimulationParams p = sludgeParams();
  p.outputs = {"x", "x_r"};
  p.measured_disturbances = {"s_i"};
  const Simulation simulation(p);
  const PlantInfo& info = simulation.info();
  EXPECT_EQ(info.name, "activated_sludge");
  EXPECT_EQ(info.frame_id, "plant");
  EXPECT_EQ(info.sample_time_s, 720.0);
  ASSERT_EQ(info.outputs.size(), 2U);
  EXPECT_EQ(info.outputs[1].name, "x_r");
  EXPECT_EQ(info.outputs[1].unit, "mg/l");
  EXPECT_EQ(info.output_frames, (std::vector<std::string>{"biomass_analyzer", "sludge_analyzer"}));
  ASSERT_EQ(info.inputs.size(), 1U);
  EXPECT_EQ(info.inputs[0].upper, 1600.0) << "the actuator's bound, not the plant's";
  ASSERT_EQ(info.disturbances.size(), 1U);
  EXPECT_EQ(info.disturbances[0].name, "s_i");
  EXPECT_EQ(info.header.run_id, 1U);
  EXPECT_EQ(simulation.measurement().disturbances, one(366.67));
}

TEST(Simulation, DefaultOutputsAreThoseOfThePlant) {
  SimulationParams p = sludgeParams();
  p.outputs.clear();
  const Simulation simulation(p);
  EXPECT_EQ(simulation.measurement().outputs, Eigen::Vector2d(200.0, 2000.0));
}

// The exchange, exactly: u(k) and d(k) act on [t_k, t_k + Ts); measurement k shows y(k), d(k) and
// u(k-1).
TEST(Simulation, EachSampleIsOneIntegrationWithItsInputAndDisturbance) {
  SimulationParams p = sludgeParams(10);
  p.disturbance = rampRecord(10);
  Simulation simulation(p);
  const auto plant = makePlant("activated_sludge");
  Integrator cvode(*plant, p.integrator);
  Vector x = p.initial_state;
  for (std::uint32_t k = 0; k < 10; ++k) {
    const Vector u = one(500.0 + 10.0 * k);
    const Vector d = Eigen::Vector2d(1300.0 + k, 366.67 - k);
    EXPECT_EQ(simulation.measurement().disturbances, d);
    ASSERT_TRUE(cvode.advance(x, u, d, 720.0).ok());
    const Measurement& next = simulation.advance(u);
    EXPECT_EQ(next.header.step, k + 1);
    EXPECT_EQ(next.header.time_ns, 1'000'000'000 + (k + 1) * 720'000'000'000LL);
    EXPECT_EQ(next.input_applied, u);
    EXPECT_EQ(next.outputs, x.head(2));
    EXPECT_EQ(simulation.state().state, x);
  }
}

TEST(Simulation, SampleNIsFinalAndStaysThere) {
  Simulation simulation(sludgeParams(3));
  for (int k = 0; k < 3; ++k) {
    EXPECT_FALSE(simulation.measurement().final);
    simulation.advance(one(570.0));
  }
  EXPECT_TRUE(simulation.measurement().final);
  const Vector before = simulation.state().state;
  EXPECT_EQ(simulation.advance(one(0.0)).header.step, 3U);
  EXPECT_EQ(simulation.advanceWithoutAction().header.step, 3U);
  EXPECT_EQ(simulation.state().state, before);
  EXPECT_FALSE(simulation.answers(simulation.measurement().header));
}

TEST(Simulation, ZeroSamplesIsEndlessAndKeepsTheLastDisturbance) {
  SimulationParams p = sludgeParams(0);
  p.disturbance = rampRecord(2);
  Simulation simulation(p);
  for (int k = 0; k < 50; ++k) EXPECT_FALSE(simulation.advance(one(570.0)).final);
  EXPECT_EQ(simulation.measurement().disturbances[0], 1302.0);
}

TEST(Simulation, OnlyActionsForThePresentSampleAnswerIt) {
  Simulation simulation(sludgeParams());
  simulation.advance(one(570.0));
  StepHeader header = simulation.measurement().header;
  EXPECT_TRUE(simulation.answers(header));
  header.step = 0;
  EXPECT_FALSE(simulation.answers(header));
  header.step = 2;
  EXPECT_FALSE(simulation.answers(header));
  header = simulation.measurement().header;
  header.run_id = 2;
  EXPECT_FALSE(simulation.answers(header));
}

TEST(Simulation, ResetRepeatsTheRunBitForBitUnderANewName) {
  SimulationParams p = sludgeParams(15);
  p.noise_std = Eigen::Vector2d(1.0, 20.0);
  p.output_delay_s = {0.0, 1000.0};
  p.disturbance = rampRecord(15);
  Simulation simulation(p);
  const auto run = [&] {
    Matrix outputs(2, 16);
    for (Eigen::Index k = 0; k <= 15; ++k) {
      outputs.col(k) = simulation.measurement().outputs;
      simulation.advance(one(400.0 + 20.0 * static_cast<double>(k)));
    }
    return outputs;
  };
  const Matrix first = run();
  EXPECT_EQ(simulation.reset(9).header.run_id, 9U);
  EXPECT_EQ(simulation.info().header.run_id, 9U);
  EXPECT_EQ(run(), first);
  Simulation other(std::move(simulation));
  other.reset(10);
  EXPECT_EQ(other.measurement().outputs, first.col(0));
}

TEST(Simulation, NoiseIsOnTheMeasurementOnlyAndFollowsItsSeed) {
  SimulationParams p = sludgeParams(2000);
  p.noise_std = Eigen::Vector2d(0.0, 20.0);
  Simulation noisy(p);
  p.noise_seed = 2;
  Simulation other(p);
  double sum = 0.0, squares = 0.0;
  EXPECT_NE(noisy.measurement().outputs[1], other.measurement().outputs[1]);
  for (int k = 0; k < 2000; ++k) {
    const Measurement& m = noisy.advance(one(570.0));
    const double noise = m.outputs[1] - noisy.state().outputs[1];
    EXPECT_EQ(m.outputs[0], noisy.state().outputs[0]);
    sum += noise;
    squares += noise * noise;
  }
  EXPECT_NEAR(sum / 2000.0, 0.0, 5.0 * 20.0 / std::sqrt(2000.0));
  EXPECT_NEAR(std::sqrt(squares / 2000.0), 20.0, 5.0 * 20.0 / std::sqrt(4000.0));
}

TEST(Simulation, TransportDelayShowsThePast) {
  SimulationParams p = sludgeParams();
  Simulation prompt(p);
  p.output_delay_s = {0.0, 720.0 * 2.5};
  Simulation late(p);
  std::vector<double> x{prompt.measurement().outputs[1]};
  for (std::size_t k = 1; k <= 8; ++k) {
    x.push_back(prompt.advance(one(1200.0)).outputs[1]);
    const double shown = late.advance(one(1200.0)).outputs[1];
    const double expected = k < 3 ? x[0] : 0.5 * (x[k - 2] + x[k - 3]);
    EXPECT_DOUBLE_EQ(shown, expected) << k;
    EXPECT_EQ(late.state().state[1], x[k]);
  }
}

TEST(Simulation, ADelayFromTheFramesEqualsOneFromTheFile) {
  SimulationParams p = sludgeParams();
  Simulation by_call(p);
  by_call.setOutputDelay(1, 1000.0);
  p.output_delay_s = {0.0, 1000.0};
  Simulation by_file(p);
  for (int k = 0; k < 10; ++k)
    EXPECT_EQ(by_call.advance(one(900.0)).outputs, by_file.advance(one(900.0)).outputs);
  EXPECT_THROW(by_call.setOutputDelay(1, 0.0), InputError) << "too late";
  by_call.reset(2);
  EXPECT_THROW(by_call.setOutputDelay(2, 0.0), InputError);
  EXPECT_THROW(by_call.setOutputDelay(0, -1.0), InputError);
}

TEST(Simulation, TheActuatorGuardsThePlant) {
  SimulationParams p = sludgeParams();
  p.actuator.limits.move = one(100.0);
  Simulation simulation(p);
  EXPECT_EQ(simulation.advance(one(5000.0)).input_applied, one(670.0));
  EXPECT_EQ(simulation.state().actuator_clips, 1U);
  EXPECT_EQ(simulation.advance(one(kNaN)).input_applied, one(670.0));
  EXPECT_EQ(simulation.state().actuator_clips, 0U);
  EXPECT_TRUE(simulation.state().input_missing);
  EXPECT_EQ(simulation.advance(Vector::Zero(4)).input_applied, one(670.0));
  EXPECT_TRUE(simulation.advance(one(600.0)).outputs.allFinite());
  EXPECT_FALSE(simulation.state().input_missing);
}

TEST(Simulation, WithoutActionsItHoldsAndThenFallsBack) {
  SimulationParams p = sludgeParams();
  p.actuator.hold_samples = 1;
  p.actuator.fallback = one(300.0);
  Simulation simulation(p);
  simulation.advance(one(800.0));
  EXPECT_EQ(simulation.advanceWithoutAction().input_applied, one(800.0));
  EXPECT_TRUE(simulation.state().input_missing);
  EXPECT_EQ(simulation.advanceWithoutAction().input_applied, one(300.0));
}

TEST(Simulation, IntegratorTroubleHoldsTheStateAndSaysWhy) {
  SimulationParams p = sludgeParams();
  p.integrator.max_steps = 1;
  Simulation simulation(p);
  EXPECT_EQ(simulation.trouble(), "");
  const Measurement& m = simulation.advance(one(570.0));
  EXPECT_EQ(m.header.step, 1U);
  EXPECT_EQ(m.outputs, p.initial_state.head(2));
  EXPECT_NE(simulation.trouble().find("sample 0"), std::string::npos) << simulation.trouble();
  EXPECT_EQ(simulation.state().trouble, simulation.trouble());
  EXPECT_NE(simulation.trouble().find("max_steps"), std::string::npos) << simulation.trouble();
  simulation.reset(2);
  EXPECT_EQ(simulation.trouble(), "");
  EXPECT_EQ(simulation.state().trouble, "");
}

TEST(Simulation, BadParamsAreErrorsThatNameTheField) {
  const auto errorOf = [](const std::function<void(SimulationParams&)>& spoil) -> std::string {
    SimulationParams p = sludgeParams();
    spoil(p);
    try {
      Simulation{p};
    } catch (const InputError& e) {
      return e.what();
    }
    return "nothing was thrown";
  };
  const auto names = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  using P = SimulationParams;
  names(errorOf([](P& p) { p.plant = "asp"; }), "plant.type 'asp'");
  names(errorOf([](P& p) { p.parameters = {{"volume", 1.0}}; }), "plant.parameters.volume");
  names(errorOf([](P& p) { p.initial_state.conservativeResize(5); }), "plant.initial_state");
  names(errorOf([](P& p) { p.initial_state[1] = kNaN; }), "plant.initial_state.x");
  names(errorOf([](P& p) { p.initial_state[0] = -1.0; }), "plant.initial_state.s");
  names(errorOf([](P& p) { p.outputs = {"y"}; }), "plant.outputs: 'y'");
  names(errorOf([](P& p) { p.outputs = {"x", "x"}; }), "only once");
  names(errorOf([](P& p) { p.measured_disturbances = {"x"}; }), "plant.measured_disturbances");
  names(errorOf([](P& p) { p.output_delay_s = {1.0}; }), "tf.sample_lines");
  names(errorOf([](P& p) { p.output_delay_s = {1.0, -1.0}; }), "delay_s");
  names(errorOf([](P& p) { p.noise_std = Vector::Ones(3); }), "noise.std");
  names(errorOf([](P& p) { p.noise_std[1] = -1.0; }), "noise.std");
  names(errorOf([](P& p) { p.disturbance_nominal[0] = -1.0; }), "disturbance.nominal.q_i");
  names(errorOf([](P& p) { p.disturbance = rampRecord(5); }), "every sample");
  names(errorOf([](P& p) { (p.disturbance = rampRecord(20)).values(1, 7) = kNaN; }),
        "sample 7.s_i");
  names(errorOf([](P& p) { p.actuator.limits.upper[0] = 4000.0; }), "actuator.input_upper.q_r");
  names(errorOf([](P& p) { p.actuator.limits.lower.resize(2); }), "actuator.input_lower");
  names(errorOf([](P& p) { p.integrator.max_steps = 0; }), "integrator.max_steps");
  names(errorOf([](P& p) { p.sample_time_s = 0.0; }), "sampling.sample_time_s");
  names(errorOf([](P& p) { p.start_time_s = 0.0; }), "start_time_s");
  names(errorOf([](P& p) { p.disturbance_commands = {{-1.0, command("q_i", 1.0)}}; }), "time_h");
  names(errorOf([](P& p) { p.disturbance_commands = {{0.0, command("q", 1.0)}}; }), "name 'q'");
}

}  // namespace plant_simulation_test
}  // namespace fpc
