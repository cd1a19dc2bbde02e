// A whole loop, probed by pulses, against margins that follow from its formulas.
#include "runtime/loop_probe.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include "fmbpc/base/text.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace runtime_loop_probe_test {

using LoopProbeOf = LoopFolder;

constexpr double kTau = 9.0, kDead = 1.0, kGain = 2.0, kSample = 0.5;  // min, K/kW

/// A lag with dead time under a PI, setpoint stepped in the middle of its hour.
std::string tank(double kp, double ki_per_h, const std::string& more = "") {
  return "plant:\n  type: transfer_matrix\n  matrix:\n"
         "    outputs: [{name: T, unit: K, nominal: 40, lower: 0, upper: 100}]\n"
         "    inputs: [{name: heat, unit: kW, nominal: 5, lower: 0, upper: 20}]\n"
         "    elements: [{output: T, from: heat, gain: 2, time_constant_min: 9, dead_time_min: "
         "1}]\n"
         "sampling: {sample_time_s: 30, duration_h: 1}\n"
         "setpoint: {schedule: [{time_h: 0.5, T: 45}]}\n"
         "controller:\n  type: pi\n  loops: [{input: heat, output: T, kp: " +
         std::to_string(kp) + ", ki_per_h: " + std::to_string(ki_per_h) + "}]\n" + more;
}

std::vector<LoopProbe> probe(const LoopFile& loop, int points) {
  const LoopCourse course(loop);
  std::vector<LoopProbe> found;
  for (const CoursePoint& point : course.points(points))
    found.push_back(probeLoop(course.stayingAt(loop, point), point));
  return found;
}

/// L(z) of the lag with two samples of dead time and the PI as it is sampled: the integral takes
/// the present error, so that u = kp e + ki T (e + e(-1) + ...).
std::complex<double> loopGain(double kp, double ki_per_h, double turn) {
  const std::complex<double> z = std::polar(1.0, turn);
  const double a = std::exp(-kSample / kTau);
  const std::complex<double> plant = kGain * (1.0 - a) / (z - a) * std::pow(z, -2);
  return plant * (kp + ki_per_h * kSample / 60.0 / (z - 1.0));
}

double root(double low, double high, const std::function<double(double)>& f) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) > 0.0) == (f(low) > 0.0) ? low : high) = middle;
  }
  return low;
}

TEST_F(LoopProbeOf, APiOnALagWithDeadTimeHasTheMarginsOfItsFormula) {
  const double kp = 1.5, ki = 10.0;
  const auto found = probe(readLoop(write("a.yaml", tank(kp, ki))), 2);
  ASSERT_EQ(found.size(), 2U) << "before and after the step";
  const auto L = [&](double turn) { return loopGain(kp, ki, turn); };
  const double one = root(1e-3, 1.0, [&](double w) { return std::abs(L(w)) - 1.0; });
  const double real = root(one, 1.5, [&](double w) { return L(w).imag(); });
  ASSERT_LT(L(real).real(), 0.0);
  for (const LoopProbe& p : found) {
    ASSERT_EQ(p.result, ProbeResult::kLinear) << p.words;
    const LoopMargins m = p.response->margins(0);
    EXPECT_NEAR(m.gain_upper, -1.0 / L(real).real(), 2e-3 * m.gain_upper);
    EXPECT_NEAR(m.delay_s, std::arg(-L(one)) / one * 30.0, 0.2);
    EXPECT_NEAR(m.phase_deg, std::arg(-L(one)) * 57.29577951308232, 0.1);
  }
  EXPECT_NEAR(found[0].outputs[0], 40.0, 1e-4);
  EXPECT_NEAR(found[1].outputs[0], 45.0, 1e-4);
}

/// Two coupled lags under two PI; the second heater in this part of a kW.
std::string twoHeaters(double unit) {
  const auto number = [](double value) { return exactText(value); };
  const std::string second = ", from: oil, time_constant_min: 9, dead_time_min: 1, gain: ";
  return "plant:\n  type: transfer_matrix\n  matrix:\n"
         "    outputs: [{name: A, nominal: 40, lower: 0, upper: 100}, {name: B, nominal: 40, "
         "lower: "
         "0, upper: 100}]\n"
         "    inputs: [{name: heat, nominal: 5, lower: 0, upper: 20}, {name: oil, nominal: " +
         number(5.0 / unit) + ", lower: 0, upper: " + number(20.0 / unit) +
         "}]\n    elements:\n"
         "      - {output: A, from: heat, gain: 2, time_constant_min: 9, dead_time_min: 1}\n"
         "      - {output: B, from: heat, gain: 1.5, time_constant_min: 9, dead_time_min: 1}\n"
         "      - {output: A" +
         second + number(unit) + "}\n      - {output: B" + second + number(2.0 * unit) +
         "}\nsampling: {sample_time_s: 30, duration_h: 1}\n"
         "controller:\n  type: pi\n  loops:\n"
         "    - {input: heat, output: A, kp: 1, ki_per_h: 7}\n"
         "    - {input: oil, output: B, kp: " +
         number(1.0 / unit) + ", ki_per_h: " + number(7.0 / unit) + "}\n";
}

TEST_F(LoopProbeOf, ThePeakDoesNotDependOnTheUnitOfAnInput) {
  const auto peak = [&](double unit) {
    const LoopProbe found = probe(readLoop(write("a.yaml", twoHeaters(unit))), 1)[0];
    EXPECT_EQ(found.result, ProbeResult::kLinear) << found.words;
    return found.response ? found.response->peak() : 0.0;
  };
  const double in_kw = peak(1.0);
  EXPECT_GT(in_kw, 1.1);
  EXPECT_NEAR(peak(1e-3), in_kw, 1e-3 * in_kw);
}

/// The gain margin is the factor at which the loop is lost.
TEST_F(LoopProbeOf, BeyondTheGainMarginItGrowsOrSwings) {
  const double kp = 1.5, ki = 10.0;
  const double factor =
      probe(readLoop(write("a.yaml", tank(kp, ki))), 1)[0].response->margins(0).gain_upper;
  for (const double part : {0.98, 1.02}) {
    const double k = part * factor;
    const LoopFile loop = readLoop(write("b.yaml", tank(k * kp, k * ki)));
    const ProbeResult result = probe(loop, 1)[0].result;
    if (part < 1.0) {
      EXPECT_EQ(result, ProbeResult::kLinear) << part;
    } else {
      EXPECT_TRUE(result == ProbeResult::kGrows || result == ProbeResult::kSwings) << part;
    }
  }
}

TEST_F(LoopProbeOf, AnInputAtItsLimitHasNoFeedback) {
  const LoopFile loop =
      readLoop(write("a.yaml", tank(1.5, 10.0, "actuator: {input_upper: {heat: 5.5}}\n")));
  const auto found = probe(loop, 2);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].result, ProbeResult::kLinear);
  EXPECT_EQ(found[1].result, ProbeResult::kHeld) << "45 K need 7.5 kW";
}

/// What the loop does to noise is not its margins' business.
TEST_F(LoopProbeOf, NoiseIsLeftOut) {
  const auto still = probe(readLoop(write("a.yaml", tank(1.5, 10.0))), 1)[0];
  const auto noisy =
      probe(readLoop(write(
                "b.yaml",
                tank(1.5, 10.0,
                     "noise: {std: {T: 0.5}}\ndisturbance: {noise_std: {gain/T/heat: 0.2}}\n"))),
            1)[0];
  ASSERT_TRUE(noisy.response);
  EXPECT_EQ(noisy.response->margins(0).gain_upper, still.response->margins(0).gain_upper);
}

/// A slow drive behind the actuator costs margin; the file names it.
TEST_F(LoopProbeOf, ADriveCountsToTheLoop) {
  const auto quick = probe(readLoop(write("a.yaml", tank(1.5, 10.0))), 1)[0];
  const auto slow = probe(
      readLoop(write("b.yaml", tank(1.5, 10.0, "actuator: {lag: {heat: {t90_s: 120}}}\n"))), 1)[0];
  EXPECT_LT(slow.response->margins(0).gain_upper, 0.8 * quick.response->margins(0).gain_upper);
}

TEST_F(LoopProbeOf, PointsAreTheExtremesOfTheRun) {
  const LoopCourse course(readLoop("cstr_tracking"));
  std::vector<double> setpoints;
  for (const CoursePoint& p : course.points(3)) setpoints.push_back(p.setpoint[0]);
  std::sort(setpoints.begin(), setpoints.end());
  EXPECT_EQ(setpoints, (std::vector<double>{0.045, 0.1, 0.15}));
  EXPECT_EQ(course.points(9).size(), 3U) << "no point twice";
}

}  // namespace runtime_loop_probe_test
}  // namespace fpc
