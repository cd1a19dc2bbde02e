// Figures of a loop's health against answers known on paper.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "fmbpc/base/input_error.hpp"
#include "simulated_loops.hpp"
#include "supervision/health/finite_runs.hpp"

namespace fpc {
namespace health_test {

std::vector<double> noise(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 engine = seededEngine(seed, {});
  std::vector<double> e(n);
  for (double& v : e) v = standardNormal(engine);
  return e;
}

/// The error under a law of dead time b whose closed loop is sum psi(i) e(t - i).
std::vector<double> filtered(const std::vector<double>& e, const std::vector<double>& psi) {
  std::vector<double> y(e.size(), 0.0);
  for (std::size_t t = 0; t < e.size(); ++t)
    for (std::size_t i = 0; i < psi.size() && i <= t; ++i) y[t] += psi[i] * e[t - i];
  return y;
}

double exactIndex(const std::vector<double>& psi, int dead_time) {
  double least = 0.0, all = 0.0;
  for (std::size_t i = 0; i < psi.size(); ++i) {
    if (static_cast<int>(i) < dead_time) least += psi[i] * psi[i];
    all += psi[i] * psi[i];
  }
  return least / all;
}

TEST(MinimumVarianceIndex, IsThatOfThePaper) {
  // first order, minimum variance, ARMA(2,1), lightly damped: each with dead times of 1 to 8
  std::vector<std::vector<double>> loops;
  for (const double a : {0.3, 0.8, 0.95}) {
    std::vector<double> psi;
    for (int i = 0; i < 300; ++i) psi.push_back(std::pow(a, i));
    loops.push_back(psi);
  }
  loops.push_back({1.0, 0.9, 0.81});  // minimum variance for a dead time of 3
  for (const double radius : {0.7, 0.93}) {
    std::vector<double> psi{1.0, 2.0 * radius * std::cos(0.5) - 0.4};
    for (int i = 2; i < 400; ++i)
      psi.push_back(2.0 * radius * std::cos(0.5) * psi[psi.size() - 1] -
                    radius * radius * psi[psi.size() - 2]);
    loops.push_back(psi);
  }
  double worst = 0.0;
  for (std::size_t loop = 0; loop < loops.size(); ++loop)
    for (const int dead_time : {1, 2, 3, 5, 8})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const MinimumVariance found =
            minimumVariance(filtered(noise(20000, seed), loops[loop]), dead_time);
        const double exact = exactIndex(loops[loop], dead_time);
        EXPECT_NEAR(found.index, exact, 0.05) << loop << " " << dead_time << " " << seed;
        worst = std::max(worst, std::abs(found.index - exact));
      }
  RecordProperty("worst_thousandths", static_cast<int>(1000.0 * worst));
}

TEST(MinimumVarianceIndex, HeedsHoles) {
  const std::vector<double> psi{1.0, 0.8, 0.64, 0.5, 0.4, 0.3, 0.2, 0.1};
  std::vector<double> y = filtered(noise(9000, 2), psi);
  for (std::size_t k = 0; k < y.size(); ++k)
    if (k % 400 < 60) y[k] = kNaN;
  EXPECT_NEAR(minimumVariance(y, 2).index, exactIndex(psi, 2), 0.05);
}

TEST(MinimumVarianceIndex, SaysNothingOfTooLittle) {
  EXPECT_TRUE(std::isnan(minimumVariance(noise(12, 1), 3).index));
  EXPECT_THROW(minimumVariance(noise(100, 1), 0), InputError);
}

TEST(OscillationOf, ASineInNoiseHasItsPeriodAndAmplitude) {
  for (const double period : {7.3, 40.0, 311.0}) {
    std::vector<double> y = noise(8000, 3);
    for (std::size_t k = 0; k < y.size(); ++k)
      y[k] = 0.7 * y[k] + 2.0 * std::sin(6.283185307179586 * static_cast<double>(k) / period);
    const Oscillation o = findOscillation(y);
    ASSERT_TRUE(o.found) << period;
    EXPECT_NEAR(o.period / period, 1.0, 0.01);
    EXPECT_NEAR(o.amplitude, 2.0, 0.2);
    EXPECT_LT(o.unrest, 0.3);
  }
}

TEST(OscillationOf, NoiseOfAnyColourIsNone) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    for (const double a : {0.0, 0.6, 0.95}) {
      std::vector<double> y = noise(4000, seed);
      for (std::size_t k = 1; k < y.size(); ++k) y[k] += a * y[k - 1];
      EXPECT_FALSE(findOscillation(y).found) << seed << " " << a;
    }
}

TEST(Valves, BacklashIsAPlayOfItsBand) {
  StickingValve valve(2.0, 0.0);
  double least = 1e9, most = -1e9;
  for (int k = 0; k < 400; ++k) {
    const double x = valve.move(10.0 + 5.0 * std::sin(k / 20.0));
    if (k < 200) continue;
    least = std::min(least, x);
    most = std::max(most, x);
  }
  EXPECT_NEAR(most - least, 8.0, 0.05);
}

TEST(Valves, AStickingValveMovesByItsJump) {
  SlippingValve valve(2.0, 2.0);
  EXPECT_EQ(valve.move(10.0), 10.0);
  EXPECT_EQ(valve.move(11.9), 10.0);
  EXPECT_NEAR(valve.move(12.1), 12.1, 1e-12);
  EXPECT_NEAR(valve.move(10.2), 12.1, 1e-12);
}

TEST(Valves, ABandIsCertainOnlyAfterTenTurns) {
  for (const double swings : {2.0, 20.0}) {
    const std::vector<double> e = noise(4000, 4);
    std::vector<double> u(e.size(), 50.0), y(e.size(), 0.0);
    StickingValve valve(6.0, 0.0);
    double x = valve.move(50.0);
    for (std::size_t k = 1; k < u.size(); ++k) {
      y[k] = 0.9 * y[k - 1] + 0.1 * (x - 50.0) + 0.1 * e[k];
      u[k] = 50.0 + 10.0 * std::sin(6.283185307179586 * swings * static_cast<double>(k) / 4000.0);
      x = valve.move(u[k]);
    }
    EXPECT_EQ(fitValve(u, y, 1, 3).plays, swings > 10.0) << swings;
  }
}

TEST(SensorFaultsOf, AStepOfTheLoadIsNoSpike) {
  // as a loop answers it: up at once, back in a few samples
  std::vector<double> y(1000, 0.0);
  const std::vector<double> e = noise(1000, 6);
  for (std::size_t k = 1; k < y.size(); ++k) y[k] = k % 200 == 0 ? 5.0 : 0.6 * y[k - 1];
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += 0.01 * e[k];
  EXPECT_EQ(sensorFaults(y).spikes, 0.0);
}

TEST(SensorFaultsOf, SpikesAndStandingValuesAreCounted) {
  std::vector<double> y = noise(3000, 5);
  EXPECT_FALSE(sensorFaults(y).isFrozen());
  EXPECT_FALSE(sensorFaults(y).hasSpikes());
  for (std::size_t k = 100; k < 3000; k += 200) y[k] += 40.0;
  EXPECT_NEAR(sensorFaults(y).spikes, 15.0 / 3000.0, 1e-9);
  for (std::size_t k = 1000; k < 1400; ++k) y[k] = y[999];
  const SensorFaults frozen = sensorFaults(y);
  EXPECT_TRUE(frozen.isFrozen());
  EXPECT_EQ(frozen.frozen_samples, 400);
}

TEST(ModelAgeOf, AModelOfOtherGainIsOld) {
  const StepResponse truth{
      1.0, {0.2, 0.5, 0.7, 0.85, 0.95, 1.0}, {0.01, 0.01, 0.01, 0.01, 0.01, 0.01}};
  StepResponse old = truth;
  old.std.clear();
  EXPECT_FALSE(compareModel(old, truth).outdated);
  for (double& v : old.value) v *= 2.0;
  const ModelAge age = compareModel(old, truth);
  EXPECT_TRUE(age.outdated);
  EXPECT_NEAR(age.gain_ratio, 0.5, 1e-12);
}

TEST(HealthOfALoop, SharesAndLimitsAreCounted) {
  ControlRecord r = drawLoop(judgingPlants()[0], Fault::kNone, 1, 1000);
  r.duty.assign(1000, LoopDuty::kAutomatic);
  for (std::size_t k = 0; k < 100; ++k) r.duty[k] = LoopDuty::kManual;
  for (std::size_t k = 100; k < 150; ++k) r.duty[k] = LoopDuty::kFallback;
  for (std::size_t k = 500; k < 670; ++k) r.u[k] = 100.0;
  const LoopHealth h = judgeLoop(r);
  EXPECT_DOUBLE_EQ(h.automatic, 0.85);
  EXPECT_DOUBLE_EQ(h.manual, 0.1);
  EXPECT_DOUBLE_EQ(h.fallback, 0.05);
  EXPECT_NEAR(h.at_limits, 170.0 / 850.0, 1e-12);
  r.u.pop_back();
  EXPECT_THROW(judgeLoop(r), InputError);
}

TEST(HealthOfALoop, TheCauseOfAFaultIsFound) {
  int right = 0, faults = 0, alarms = 0, healthy = 0;
  for (const Process& plant : judgingPlants())
    for (const Fault fault : kFaults)
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const LoopHealth h = judgeLoop(drawLoop(plant, fault, seed));
        if (fault == Fault::kNone) {
          ++healthy;
          alarms += h.cause != LoopCause::kHealthy ? 1 : 0;
        } else {
          ++faults;
          right += h.cause == causeOf(fault) ? 1 : 0;
        }
      }
  std::printf("right cause: %d of %d; alarms: %d of %d healthy loops\n", right, faults, alarms,
              healthy);
  EXPECT_GE(right, 0.9 * faults);
  EXPECT_LE(alarms, 0.05 * healthy);
}

/// A process under its own PI (simc) whose load walks slowly; its gain changes with u.
template <typename Bent>
ControlRecord slowlyLoaded(Bent bent) {
  const Process p = judgingPlants()[0];
  const Pi c = simc(p, 1.0);
  ControlRecord r;
  r.output = "y";
  std::mt19937_64 engine = seededEngine(11, {});
  ProcessState state(p);
  double integral = 0.0, load = 0.0, walk = 0.0, setpoint = 0.0, y = 0.0;
  for (int k = 0; k < 6000; ++k) {
    if (k % 300 == 150) setpoint = 10.0 * (uniform(engine) - 0.5);
    const double e = setpoint - y, u = c.gain * (e + integral);
    integral += e / c.integral_time;
    r.y.push_back(y);
    r.setpoint.push_back(setpoint);
    r.u.push_back(u);
    walk = 0.995 * walk + 0.05 * standardNormal(engine);
    load += 0.005 * (walk - load);
    y = state.step(bent(u) + 3.0 * load);
  }
  r.model = stepOf(p, 400);
  return r;
}

TEST(HealthOfALoop, ASlowLoadDoesNotMakeItSluggish) {
  const LoopHealth h = judgeLoop(slowlyLoaded([](double u) { return u; }));
  EXPECT_EQ(h.cause, LoopCause::kHealthy) << nameOf(h.cause);
  EXPECT_GT(h.error_under_pi, 0.85);
}

TEST(HealthOfALoop, AGainThatChangesIsNoValve) {
  const LoopHealth h = judgeLoop(slowlyLoaded([](double u) { return u + 0.3 * std::tanh(u); }));
  EXPECT_FALSE(h.valve.sticks || h.valve.plays);
}

TEST(HealthOfALoop, ADailySwingIsNoFault) {
  ControlRecord r;
  r.output = "y";
  r.sample_time_s = 900.0;
  const std::vector<double> e = noise(3000, 7);
  for (const double hours : {24.0, 12.0, 17.0}) {
    r.y.clear();
    for (std::size_t k = 0; k < e.size(); ++k)
      r.y.push_back(0.2 * e[k] +
                    std::sin(6.283185307179586 * static_cast<double>(k) / (4.0 * hours)));
    const LoopHealth h = judgeLoop(r);
    EXPECT_TRUE(h.oscillation.found) << hours;
    EXPECT_EQ(h.isDaily(), hours != 17.0);
    EXPECT_EQ(h.cause == LoopCause::kOscillatingLoad, hours == 17.0) << nameOf(h.cause);
  }
}

TEST(HealthOfALoop, AnotherLoopOfOnePeriodIsNamed) {
  std::vector<LoopHealth> loops(2);
  loops[0].output = "level";
  loops[1].output = "flow";
  for (LoopHealth& h : loops) {
    h.sample_time_s = 1.0;
    h.oscillation.found = true;
    h.oscillation.period = 50.0;
  }
  loops[0].cause = LoopCause::kOscillatingLoad;
  loops[1].cause = LoopCause::kStiction;
  relateLoops(loops);
  ASSERT_EQ(loops[0].remarks.size(), 1U);
  EXPECT_NE(loops[0].remarks[0].find("flow"), std::string::npos);
}

}  // namespace health_test
}  // namespace fpc
