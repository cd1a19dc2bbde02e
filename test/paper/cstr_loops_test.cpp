// The reactor's experiments of blazic2007, run in process: sums of (y_r - y)^2 over
// 401 samples. What the paper prints, what an independent reference reaches where the paper is
// silent, and the baselines that the paper did not try. Every figure is printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "control/pi/pi.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_cstr_loops_test {

RunRecord recordOf(const std::string& name, const Overrides& overrides = {}) {
  const RunRecord record = runLoop(readLoop(name, overrides));
  EXPECT_TRUE(record.complete) << name;
  EXPECT_EQ(record.samples.size(), 401U) << name;
  return record;
}

/// sum of (y_r - y)^2, y_r before its update, y as measured.
double score(const std::string& name, const Overrides& overrides = {}) {
  const LoopFile loop = readLoop(name, overrides);
  const Summary summary = summarize(loop, recordOf(name, overrides), 0.0);
  EXPECT_EQ(summary.input_violations + summary.move_violations, 0U) << name;
  std::printf("%-28s %.6f\n", name.c_str(), summary.outputs[0].ise_reference);
  return summary.outputs[0].ise_reference;
}

TEST(CstrScore, TakesTheReferenceBeforeItsUpdateFromTheStateAtRest) {
  const RunRecord record = recordOf("cstr_tracking");
  double y_r = record.samples[0].measurement.outputs[0], sum = 0.0;
  for (std::size_t k = 0; k <= 400; ++k) {
    const SampleRecord& sample = record.samples[k];
    const double setpoint = k < 100 ? 0.15 : k < 200 ? 0.1 : k < 300 ? 0.045 : 0.1;
    ASSERT_EQ(sample.tracking.setpoint[0], setpoint) << "sample " << k;
    ASSERT_NEAR(sample.tracking.reference[0], y_r, 1e-14) << "sample " << k;
    sum += std::pow(y_r - sample.measurement.outputs[0], 2);
    y_r = 0.96 * y_r + 0.04 * setpoint;
  }
  EXPECT_NEAR(score("cstr_tracking"), sum, 1e-12);
  const RunRecord baseline = recordOf("cstr_tracking_pi");
  for (std::size_t k = 0; k <= 400; ++k)
    ASSERT_EQ(baseline.samples[k].tracking.reference, record.samples[k].tracking.reference);
}

TEST(CstrScore, TheDisturbanceComesAndGoesOnTime) {
  const RunRecord record = recordOf("cstr_disturbance");
  for (std::size_t k = 0; k < 400; ++k) {
    const double expected = k >= 50 && k < 150 ? 3.0 : k >= 220 && k < 320 ? -3.0 : 0.0;
    ASSERT_EQ(record.samples[k].state.disturbances[0], expected) << "sample " << k;
    ASSERT_EQ(record.samples[k].measurement.disturbances.size(), 0) << "unseen";
  }
}

TEST(CstrPaper, PiIsWithinFivePercent) {
  EXPECT_NEAR(score("cstr_tracking_pi"), 0.0165, 0.05 * 0.0165);
  EXPECT_NEAR(score("cstr_disturbance_pi"), 0.0076, 0.05 * 0.0076);
}

TEST(CstrPaper, TheLawAsPrintedIsWithinFivePercentWithTheCalibratedModel) {
  EXPECT_NEAR(score("cstr_tracking_literal_b"), 0.0061, 0.05 * 0.0061);
  EXPECT_NEAR(score("cstr_disturbance_literal_b"), 0.0036, 0.05 * 0.0036);
}

TEST(CstrReference, TheLawAsPrintedWithModelA) {
  EXPECT_NEAR(score("cstr_tracking_literal"), 0.00433, 2e-5);
  EXPECT_NEAR(score("cstr_disturbance_literal"), 0.00512, 2e-5);
}

TEST(CstrReference, InputOutputStatesDoBetterThanThePrintedOnes) {
  EXPECT_LE(score("cstr_tracking"), 0.0036);
  EXPECT_LE(score("cstr_disturbance"), 0.0035);
}

TEST(CstrReference, AimingWhereTheEffectIsMeasuredHalvesTheError) {
  EXPECT_NEAR(score("cstr_tracking_preview"), 0.00177, 1e-5);
  EXPECT_NEAR(score("cstr_disturbance_preview"), 0.00263, 1e-5);
}

TEST(CstrReference, GainScheduledPiIsTheHonestBaseline) {
  const double tracking = score("cstr_tracking_gspi");
  EXPECT_NEAR(tracking, 0.00457, 0.00457 * 0.01);
  EXPECT_NEAR(score("cstr_disturbance_gspi"), 0.0073, 0.0073 * 0.01);
  EXPECT_LT(score("cstr_tracking"), tracking);
  EXPECT_LT(score("cstr_disturbance"), 0.0073);
}

/// The coolant flow under which the reactor rests at this concentration, by bisection.
double restFlow(const Plant& plant, double concentration) {
  Vector x = Eigen::Vector2d(concentration, 0.0), u(1), dxdt(2);
  const Vector d = Vector::Zero(2);
  const auto root = [&](double& value, double lower, double upper, Eigen::Index row) {
    for (int i = 0; i < 100; ++i) {
      value = 0.5 * (lower + upper);
      plant.derivatives(x, u, d, dxdt);
      (dxdt[row] > 0.0 ? lower : upper) = value;
    }
  };
  u[0] = 0.0;
  root(x[1], 300.0, 600.0, 0);
  root(u[0], 1.0, 500.0, 1);
  return u[0];
}

TEST(CstrReference, TheGainScheduleIsTheSlopeOfTheStaticCurve) {
  const auto plant = makePlant("cstr");
  const auto slope = [&](double y) {
    return (restFlow(*plant, y + 1e-4) - restFlow(*plant, y - 1e-4)) / 2e-4;
  };
  EXPECT_NEAR(restFlow(*plant, 0.1), 103.4066, 1e-3);
  for (const char* name :
       {"cstr_tracking_gspi", "cstr_disturbance_gspi", "cstr_small_steps_gspi"}) {
    const auto points = readLoop(name).controllerParams<PiParams>().loops[0].gain_schedule;
    ASSERT_EQ(points.size(), 23U);
    for (const auto& point : points)
      EXPECT_NEAR(point.value, slope(point.at) / slope(0.1), 2e-4 * (1.0 + point.value));
  }
}

TEST(CstrReference, OnSmallStepsThePrintedLawDoesNotBeatPiAndTheOtherDoes) {
  const double pi = score("cstr_small_steps_pi"), a = score("cstr_small_steps_literal"),
               b = score("cstr_small_steps_literal_b"), states = score("cstr_small_steps");
  score("cstr_small_steps_gspi");
  EXPECT_NEAR(pi, 0.00079, 1e-5);
  EXPECT_NEAR(a, 0.00092, 1e-5);
  EXPECT_NEAR(b, 0.00082, 1e-5);
  EXPECT_NEAR(states, 0.00041, 1e-5);
}

/// Nothing that a controller does at k is seen before k + 6: five samples of sample line and one of
/// the plant.
constexpr std::size_t kDeadSamples = 6;

// Tracking: after each setpoint step the measurement stays for five samples after k while y_r moves
// on. Disturbance: seen kDeadSamples after it comes, answered kDeadSamples after that; in between
// the process runs open loop.
TEST(CstrReference, NoLawIsBetterThanTheDeadTimeAllows) {
  double tracking = 0.0;
  for (const double step : {0.05, -0.05, -0.055, 0.055})
    for (std::size_t i = 1; i < kDeadSamples; ++i)
      tracking += std::pow(step * (1.0 - std::pow(0.96, static_cast<double>(i))), 2);
  double disturbance = 0.0;
  for (const char* value : {"3", "-3"}) {
    const RunRecord open =
        recordOf("cstr_disturbance_pi", {{"controller.loops.0.kp", "0"},
                                         {"controller.loops.0.ki_per_h", "0"},
                                         {"disturbance.commands.0.time_h", "0"},
                                         {"disturbance.commands.0.value", value},
                                         {"disturbance.commands.1.time_h", "0.5"},
                                         {"disturbance.commands.2.time_h", "0.5"}});
    for (std::size_t k = kDeadSamples; k < 2 * kDeadSamples; ++k)  // comes and goes: twice
      disturbance += 2.0 * std::pow(open.samples[k].measurement.outputs[0] - 0.1, 2);
  }
  std::printf("dead-time lower bound        %.5f %.5f\n", tracking, disturbance);
  EXPECT_NEAR(tracking, 0.00086, 1e-5);
  EXPECT_NEAR(disturbance, 0.00053, 1e-5);
  EXPECT_LT(tracking, score("cstr_tracking_preview"));
  EXPECT_LT(disturbance, score("cstr_disturbance_preview"));
}

}  // namespace paper_cstr_loops_test
}  // namespace fpc
