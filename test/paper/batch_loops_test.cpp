// The batch reactor's experiment (karer2007, section 6) from four initial states, pooled:
// rms of the core's temperature in the steady windows, switches of the on/off valves, water. The
// bounds are those the project promises; every figure is printed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_batch_loops_test {

struct Pooled {
  double rms[3]{};  // windows at 62, 26, 35 degC
  double mean_error[3]{};
  std::vector<double> switches, water;  // per start; kC
};

Pooled runAll(const std::string& name, const Overrides& overrides = {}) {
  const char* starts[] = {"{T: 20, Tw: 20}", "{T: 18, Tw: 18}", "{T: 22, Tw: 25}",
                          "{T: 20, Tw: 30}"};
  Pooled pooled;
  for (const char* start : starts) {
    Overrides all = overrides;
    all.emplace_back("plant.initial_state", start);
    const LoopFile loop = readLoop(name, all);
    const RunRecord record = runLoop(loop);
    EXPECT_TRUE(record.complete) << name;
    const Summary summary = summarize(loop, record, 0.0);
    EXPECT_EQ(summary.input_violations + summary.actuator_clips, 0U) << name;
    for (std::size_t w = 0; w < 3; ++w) {
      pooled.rms[w] += 0.25 * summary.windows.at(w).rmse * summary.windows[w].rmse;
      pooled.mean_error[w] += 0.25 * summary.windows[w].mean_error;
    }
    pooled.switches.push_back(static_cast<double>(summary.inputs[1].switches));
    pooled.water.push_back(summary.consumption.at(0).second);
  }
  for (double& r : pooled.rms) r = std::sqrt(r);
  std::printf("%-26s rms %.3f %.3f %.3f, mean error %+.3f %+.3f %+.3f, switches", name.c_str(),
              pooled.rms[0], pooled.rms[1], pooled.rms[2], pooled.mean_error[0],
              pooled.mean_error[1], pooled.mean_error[2]);
  for (const double s : pooled.switches) std::printf(" %.0f", s);
  std::printf(", water");
  for (const double w : pooled.water) std::printf(" %.0f", w);
  std::printf(" kg\n");
  return pooled;
}

TEST(BatchLoops, TheFuzzyModelBeatsTheLinearOneWhereItIsClaimed) {
  const Pooled fuzzy = runAll("batch_fuzzy_eq45"), linear = runAll("batch_linear_eq45");
  EXPECT_LE(fuzzy.rms[0], 0.35 * linear.rms[0]);
  EXPECT_LE(fuzzy.rms[1], 0.70 * linear.rms[1]);
  // the reference's figures, 10 %
  const double printed_fuzzy[] = {0.230, 0.027, 0.021}, printed_linear[] = {1.58, 0.112, 0.030};
  for (int w = 0; w < 3; ++w) {
    EXPECT_NEAR(fuzzy.rms[w] / printed_fuzzy[w], 1.0, 0.1) << "window " << w;
    EXPECT_NEAR(linear.rms[w] / printed_linear[w], 1.0, 0.1) << "window " << w;
  }
  // above the linear one at 62 and 35 as figures 12 and 14; at 26 as well, unlike figure 13
  for (int w = 0; w < 3; ++w) EXPECT_GT(fuzzy.mean_error[w], linear.mean_error[w]);
}

TEST(BatchLoops, CostsOfSwitchingSaveSwitchesAndWater) {
  const Pooled plain = runAll("batch_fuzzy_eq44"), priced = runAll("batch_fuzzy_eq45");
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LE(priced.switches[i], plain.switches[i]) << "start " << i;
    EXPECT_EQ(priced.switches[i], 2.0) << "start " << i;
    EXPECT_LE(priced.water[i], plain.water[i]) << "start " << i;
  }
}

// 0.1 degC on both thermometers, and a recipe that is not known ahead.
TEST(BatchLoops, AlsoWithNoiseAndWithoutPreview) {
  const Overrides noise{{"noise.std", "{T: 0.1, Tw: 0.1}"}, {"controller.preview", "false"}};
  const Pooled plain = runAll("batch_fuzzy_eq44", noise),
               priced = runAll("batch_fuzzy_eq45", noise);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(plain.switches[i], priced.switches[i]) << "start " << i;
    EXPECT_EQ(priced.switches[i], 2.0) << "start " << i;
    EXPECT_LE(priced.water[i], plain.water[i]) << "start " << i;
  }
}

// Another charge: a core of 20 % more heat capacity, hot water of 70 instead of 75 degC, cold of 14
// instead of 12.
TEST(BatchLoops, APlantUnlikeTheModelIsStillControlled) {
  const Overrides charge{{"plant.parameters.core_heat_capacity", "6.25e6"},
                         {"disturbance.nominal", "{T_H: 70, T_C: 14, T_0: 20}"}};
  const Pooled fuzzy = runAll("batch_fuzzy_eq45", charge);
  const Pooled linear = runAll("batch_linear_eq45", charge);
  EXPECT_LT(fuzzy.rms[0], linear.rms[0]);
  EXPECT_LT(fuzzy.rms[0], 1.0);
  EXPECT_LT(fuzzy.rms[1], 1.0);
  EXPECT_LT(fuzzy.rms[2], 1.0);
}

TEST(BatchLoops, TheBoundChangesNothingButTheWork) {
  const Pooled reach = runAll("batch_fuzzy_eq45");
  const Pooled cost = runAll("batch_fuzzy_eq45", {{"controller.bound", "cost"}});
  for (int w = 0; w < 3; ++w) EXPECT_EQ(reach.rms[w], cost.rms[w]);
  EXPECT_EQ(reach.water, cost.water);
}

// Section 4.5: how long the inputs are held.
TEST(BatchLoops, LongerBlocksControlWorse) {
  double before = 0.0;
  for (const char* hold : {"5", "15", "30", "60"}) {
    const Pooled held = runAll("batch_fuzzy_eq44", {{"controller.hold_samples", hold}});
    EXPECT_GT(held.rms[0], before) << "Z " << hold;
    before = held.rms[0];
  }
}

}  // namespace paper_batch_loops_test
}  // namespace fpc
