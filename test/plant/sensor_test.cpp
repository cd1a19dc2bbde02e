#include "plant/instruments.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "plant/sensor.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_sensor_test {

TEST(Drive, AStemThatSticksStandsUntilTheCommandIsFarOffAndThenSlipsToIt) {
  Instruments valve({}, {{1, 0.0, 0.0, 1.0}}, {"y"}, {}, 10.0);
  const auto at = [](double value) { return Vector(Vector::Constant(1, value)); };
  valve.reset(at(0.0), Vector(), at(5.0));
  const double commands[] = {5.4, 6.0, 6.1, 5.2, 5.0}, positions[] = {5.0, 5.0, 6.1, 6.1, 5.0};
  for (int k = 0; k < 5; ++k) EXPECT_EQ(valve.drive(at(commands[k]))[0], positions[k]) << k;
  EXPECT_THROW(Instruments({}, {{1, 0.0, 0.0, -1.0}}, {"y"}, {}, 10.0), InputError);
}

TEST(LagChain, OneLagFollowsAStepAsOnPaper) {
  LagChain lag(1, 100.0);
  lag.reset(2.0);
  const double mean = lag.advance(5.0, 5.0, 50.0);
  EXPECT_NEAR(lag.output(), 5.0 - 3.0 * std::exp(-0.5), 1e-14);
  EXPECT_NEAR(mean, 5.0 - 3.0 * 100.0 * (1.0 - std::exp(-0.5)) / 50.0, 1e-13);
}

TEST(LagChain, ARampIsFollowedLateByAllTimeConstants) {
  LagChain lags(3, 10.0);
  lags.reset(0.0);
  lags.advance(0.0, 1000.0, 1000.0);
  EXPECT_NEAR(lags.output(), 1000.0 - 30.0, 1e-9);
}

TEST(LagChain, PiecesOfTimeAddUp) {
  LagChain once(8, 51.0), pieces(8, 51.0);
  once.reset(1.0);
  pieces.reset(1.0);
  once.advance(2.0, 6.0, 400.0);
  for (int i = 0; i < 4; ++i) pieces.advance(2.0 + i, 3.0 + i, 100.0);
  EXPECT_NEAR(once.output(), pieces.output(), 1e-12);
}

TEST(LagChain, NinetyPercentOfAStepAfterT90) {
  for (const int order : {1, 2, 3, 8}) {
    LagChain lags(order, 600.0 / lagsToNinety(order));
    lags.reset(0.0);
    lags.advance(1.0, 1.0, 600.0);
    EXPECT_NEAR(lags.output(), 0.9, 1e-4) << order;
  }
  EXPECT_NEAR(lagsToNinety(1), std::log(10.0), 1e-12);
}

TEST(Sensor, ClassesAreThoseOfTheBenchmark) {
  const SensorParams A = sensorOfClass(SensorClass::kA, 0.0, 10.0);
  EXPECT_EQ(A.lags, 2);
  EXPECT_NEAR(A.lag_s, 60.0 / 3.89, 1e-12);
  const SensorParams C1 = sensorOfClass(SensorClass::kC1, 0.0, 50.0);
  EXPECT_EQ(C1.lags, 8);
  EXPECT_NEAR(C1.lag_s, 1200.0 / 11.7724, 1e-12);
  EXPECT_EQ(C1.interval_s, 300.0);
  EXPECT_EQ(C1.noise_std, 0.0);
  EXPECT_EQ(sensorOfClass(SensorClass::kD, 0.0, 1.0).interval_s, 1800.0);
}

TEST(Sensor, AnIntervalHoldsTheReadingBetweenItsSamples) {
  SensorParams p;
  p.interval_s = 300.0;
  Sensor sensor(p, 60.0, 1, 0);
  sensor.reset(0.0);
  for (int minute = 1; minute <= 12; ++minute) {
    sensor.advance(minute - 1.0, minute, 60.0);
    EXPECT_DOUBLE_EQ(sensor.take(), minute - minute % 5) << minute;
  }
}

TEST(Sensor, ADeadTimeShowsThePast) {
  SensorParams p;
  p.delay_s = 150.0;
  Sensor sensor(p, 60.0, 1, 0);
  sensor.reset(0.0);
  for (int minute = 1; minute <= 10; ++minute) {
    sensor.advance(minute - 1.0, minute, 60.0);
    EXPECT_NEAR(sensor.take(), std::max(0.0, minute - 2.5), 1e-12) << minute;
  }
}

TEST(Sensor, ItsRangeBoundsWhatItShows) {
  SensorParams p;
  p.lower = 0.0;
  p.upper = 20.0;
  p.noise_std = 5.0;
  Sensor sensor(p, 60.0, 1, 0);
  sensor.reset(19.0);
  int at_top = 0;
  for (int i = 0; i < 200; ++i) {
    sensor.advance(19.0, 19.0, 60.0);
    const double shown = sensor.take();
    EXPECT_LE(shown, 20.0);
    at_top += shown == 20.0;
  }
  EXPECT_GT(at_top, 40);
}

TEST(Sensor, AStuckSensorStaysAndComesBack) {
  SensorParams p;
  p.stuck_from_h = 1.0;
  p.stuck_to_h = 2.0;
  Sensor sensor(p, 60.0, 1, 0);
  sensor.reset(0.0);
  for (int minute = 1; minute <= 180; ++minute) {
    sensor.advance(minute - 1.0, minute, 60.0);
    const double shown = sensor.take();
    EXPECT_DOUBLE_EQ(shown, minute < 60 || minute >= 120 ? minute : 59.0) << minute;
  }
}

TEST(Sensor, AveragesHaveLessNoise) {
  SensorParams p;
  p.noise_std = 1.0;
  p.average = true;
  Sensor sensor(p, 60.0, 3, 0);
  sensor.reset(10.0);
  sensor.take();
  double squares = 0.0;
  constexpr int kSamples = 500;
  for (int k = 0; k < kSamples; ++k) {
    for (int i = 0; i < 15; ++i) sensor.advance(10.0, 10.0, 60.0);
    const double error = sensor.take() - 10.0;
    squares += error * error;
  }
  EXPECT_NEAR(std::sqrt(squares / kSamples), 1.0 / std::sqrt(15.0), 0.04);
}

TEST(Sensor, ReadingsAreLostOneByOneAndTheNoiseStays) {
  SensorParams p;
  p.noise_std = 1.0;
  Sensor whole(p, 60.0, 4, 0);
  p.lost = 0.2;
  Sensor sensor(p, 60.0, 4, 0);
  whole.reset(0.0);
  sensor.reset(0.0);
  int lost = 0;
  for (int k = 0; k < 2000; ++k) {
    whole.advance(0.0, 0.0, 60.0);
    sensor.advance(0.0, 0.0, 60.0);
    ASSERT_EQ(sensor.take(), whole.take());
    lost += sensor.loses() ? 1 : 0;
    EXPECT_FALSE(whole.loses());
  }
  EXPECT_NEAR(lost, 400, 60);
}

TEST(Sensor, BadParamsAreErrorsThatNameTheField) {
  const auto throws = [](auto spoil) {
    SensorParams p;
    spoil(p);
    EXPECT_THROW(p.validate(), InputError);
  };
  SensorParams{}.validate();
  throws([](auto& p) { p.lags = -1; });
  throws([](auto& p) { p.lost = 1.5; });
  throws([](auto& p) { p.lags = 2; });
  throws([](auto& p) { p.delay_s = -1.0; });
  throws([](auto& p) { p.interval_s = std::nan(""); });
  throws([](auto& p) { p.noise_std = -1.0; });
  throws([](auto& p) { p.lower = p.upper = 1.0; });
  throws([](auto& p) { p.stuck_from_h = 2.0, p.stuck_to_h = 1.0; });
}

SensorParams lag(double seconds) {
  SensorParams p;
  p.lags = 1;
  p.lag_s = seconds;
  return p;
}

// The sludge plant at a step of the recirculation: what the sensor shows follows what is.
TEST(Instruments, ASensorOfAnyPlantFollowsItsOutput) {
  SimulationParams p = sludgeParams();
  p.instruments.sensors["x"] = lag(720.0);
  p.instruments.step_s = 7.2;
  Simulation simulation(p);
  double expected = simulation.measurement().outputs[1];
  EXPECT_EQ(expected, 2000.0);
  for (int k = 0; k < 10; ++k) {
    const double before = simulation.state().state[1];
    const Measurement& m = simulation.advance(one(1200.0));
    const double now = simulation.state().state[1];
    EXPECT_EQ(m.outputs[0], simulation.state().state[0]) << "has no sensor";
    EXPECT_EQ(simulation.state().outputs[1], now) << "the true one";
    const double slope = now - before;  // x hardly bends within a sample
    expected = now - slope + (expected - before + slope) * std::exp(-1.0);
    EXPECT_NEAR(m.outputs[1], expected, 0.03 * std::abs(slope) + 1e-6) << k;
    expected = m.outputs[1];
  }
}

TEST(Instruments, ADriveFollowsItsCommandLate) {
  SimulationParams late = sludgeParams(), prompt = sludgeParams();
  late.actuator.drives = {{1, 720.0 * std::log(10.0)}};
  Simulation a(late), b(prompt);
  a.advance(one(1200.0));
  b.advance(one(570.0 + 630.0 * std::exp(-1.0)));  // the mean of 1200 - 630 exp(-t/Ts)
  EXPECT_EQ(a.measurement().input_applied, one(1200.0)) << "what was sent";
  const double moved = b.state().state[1] - 2000.0;
  EXPECT_GT(std::abs(moved), 1.0);
  EXPECT_NEAR(a.state().state[1] - 2000.0, moved, 0.02 * std::abs(moved));
}

TEST(Instruments, AMeasuredDisturbanceHasASensorToo) {
  SimulationParams p = sludgeParams();
  p.disturbance = rampRecord(20);
  p.instruments.sensors["q_i"] = lag(720.0);
  Simulation simulation(p);
  EXPECT_EQ(simulation.measurement().disturbances[0], 1300.0);
  const Measurement& m = simulation.advance(one(570.0));
  EXPECT_EQ(m.disturbances[0], 1300.0) << "1301 acts from now on only";
  EXPECT_EQ(m.disturbances[1], 365.67);
  EXPECT_NEAR(simulation.advance(one(570.0)).disturbances[0], 1301.0 - std::exp(-1.0), 1e-9);
}

TEST(Instruments, ResetRepeatsTheRunBitForBit) {
  SimulationParams p = sludgeParams(10);
  p.instruments.sensors["x"] = lag(300.0);
  p.instruments.sensors["x"].noise_std = 10.0;
  Simulation simulation(p);
  const auto run = [&] {
    std::vector<double> shown;
    for (int k = 0; k < 10; ++k) shown.push_back(simulation.advance(one(600.0 + k)).outputs[1]);
    return shown;
  };
  const auto first = run();
  simulation.reset(2);
  EXPECT_EQ(run(), first);
}

TEST(Instruments, SensorsOfUnknownSignalsAreRefused) {
  SimulationParams p = sludgeParams();
  p.instruments.sensors["x_r"] = lag(1.0);
  EXPECT_THROW(Simulation{p}, InputError);
}

}  // namespace plant_sensor_test
}  // namespace fpc
