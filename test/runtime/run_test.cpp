#include "runtime/run.hpp"

#include <gtest/gtest.h>

#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace loop_run_test {

LoopFile shortLoop(const std::string& name, Overrides overrides = {}) {
  overrides.emplace_back("sampling.duration_h", "40");
  return readLoop(name, overrides);
}

/// Equal to the last bit in all that a plant and a controller say.
void expectSameBits(const RunRecord& a, const RunRecord& b) {
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    EXPECT_EQ(a.samples[k].measurement.outputs, b.samples[k].measurement.outputs) << k;
    EXPECT_EQ(a.samples[k].measurement.input_applied, b.samples[k].measurement.input_applied) << k;
    EXPECT_EQ(a.samples[k].state.state, b.samples[k].state.state) << k;
    EXPECT_EQ(a.samples[k].tracking.reference, b.samples[k].tracking.reference) << k;
  }
}

TEST(Run, GivesNPlusOneMeasurementsAndNActions) {
  const RunRecord record = runLoop(shortLoop("asp_case1_clp"));
  ASSERT_EQ(record.samples.size(), 201U);
  EXPECT_TRUE(record.complete);
  EXPECT_TRUE(record.samples.back().measurement.final);
  EXPECT_TRUE(record.samples.back().has_tracking);
  EXPECT_FALSE(record.samples.back().has_action);
  for (std::size_t k = 0; k < 200; ++k) {
    EXPECT_TRUE(record.samples[k].has_action && record.samples[k].has_report) << k;
    EXPECT_EQ(record.samples[k + 1].measurement.input_applied, record.samples[k].action.input) << k;
  }
}

TEST(Run, SameFileAndSeedGiveTheSameBits) {
  for (const char* name : {"asp_case1", "asp_clp_1c", "asp_case1_pi_x", "asp_influent_csv"}) {
    const Overrides noisy = {{"noise.std", "{s: 1, x: 5}"}};
    expectSameBits(runLoop(shortLoop(name, noisy)), runLoop(shortLoop(name, noisy)));
  }
}

TEST(Run, ThePrintedTextGivesTheSameBits) {
  const LoopFile loop = shortLoop("asp_case1_general");
  expectSameBits(runLoop(loop), runLoop(parseLoop(loop.resolved, "printed")));
}

TEST(Run, AnotherSeedGivesAnotherWeek) {
  const RunRecord one = runLoop(shortLoop("asp_case1_pi_x"));
  const RunRecord two = runLoop(shortLoop("asp_case1_pi_x", {{"seed", "2"}}));
  EXPECT_NE(one.samples[50].state.disturbances, two.samples[50].state.disturbances);
}

TEST(Run, ScheduledCommandsOfTheFileActAtTheirTime) {
  const RunRecord record = runLoop(shortLoop(
      "asp_case1_pi_x", {{"disturbance.source", "constant"},
                         {"disturbance.commands", "[{time_h: 10, name: q_i, value: 1500}]"},
                         {"setpoint.commands",
                          "[{time_h: 20, name: x, value: 2100},"
                          " {time_h: 30, name: x, mode: release}]"}}));
  EXPECT_EQ(record.samples[49].state.disturbances[0], 1300.0);
  EXPECT_EQ(record.samples[50].state.disturbances[0], 1500.0);
  EXPECT_EQ(record.samples[99].tracking.setpoint[1], 1800.0);
  EXPECT_EQ(record.samples[100].tracking.setpoint[1], 2100.0);
  EXPECT_EQ(record.samples[150].tracking.setpoint[1], 2200.0);
}

TEST(Run, InputsStayInsideTheirLimitsAndMoves) {
  const LoopFile loop = shortLoop(
      "asp_case1_clp", {{"actuator.move_upper.q_r", "30"}, {"actuator.input_lower.q_r", "200"}});
  const RunRecord record = runLoop(loop);
  for (std::size_t k = 1; k < record.samples.size(); ++k) {
    const double u = record.samples[k].measurement.input_applied[0];
    const double before = record.samples[k - 1].measurement.input_applied[0];
    EXPECT_GE(u, 200.0) << k;
    EXPECT_LE(std::abs(u - before), 30.0 + 1e-9) << k;
  }
}

TEST(Run, AStopEndsItEarlyAndSaysSo) {
  std::uint32_t last = 0;
  RunOptions options;
  options.progress = [&last](std::uint32_t step, std::uint32_t samples) {
    last = step;
    EXPECT_EQ(samples, 200U);
  };
  options.stop = [&last] { return last == 20; };
  const RunRecord record = runLoop(shortLoop("asp_case1_pi_s"), options);
  EXPECT_EQ(record.samples.size(), 20U);
  EXPECT_FALSE(record.complete);
}

TEST(Run, APlantThatCannotBeMovedIsNotComplete) {
  const LoopFile loop = shortLoop("asp_case1_pi_x", {{"plant.integrator.max_steps", "1"}});
  const RunRecord record = runLoop(loop);
  EXPECT_EQ(record.samples.size(), 201U);
  EXPECT_FALSE(record.complete);
  EXPECT_EQ(record.failed_samples, 200U);
  EXPECT_NE(record.trouble.find("sample 0: more integration steps"), std::string::npos);
  for (std::size_t k = 1; k <= 200; ++k)
    EXPECT_EQ(record.samples[k].state.state, record.samples[0].state.state) << k;
  EXPECT_TRUE(record.samples[0].state.trouble.empty());
  EXPECT_EQ(record.samples[200].state.trouble.rfind("sample 199: ", 0), 0U);
}

// Columns of a matrix of one's own must not be taken for those of the plant it replaces.
TEST(Run, AMatrixOfTheLoopFileIsThePlantEverywhere) {
  const LoopFile loop = readLoop("heated_tank");
  const RunRecord record = runLoop(loop);
  ASSERT_TRUE(record.complete);
  EXPECT_NEAR(record.samples.back().measurement.outputs[0], 50.0, 0.05);
  EXPECT_EQ(record.samples.back().state.disturbances,
            (Vector(3) << 8.0, 2.5, 0.8).finished());  // T_in and the two gains
}

TEST(Run, EndlessAndExternalLoopsAreRefused) {
  const LoopFile endless =
      readLoop("asp_offset", {{"sampling.duration_h", "0"}, {"disturbance.commands", "[]"}});
  expectWords(errorOf([&] { runLoop(endless); }), {"asp_offset", "sampling.duration_h"});
  const LoopFile external = readLoop("example_external");
  expectWords(errorOf([&] { runLoop(external); }), {"example_external", "plant.type"});
  expectWords(errorOf([] { makeOptimizerSession(readLoop("asp_case1")); }), {"asp_case1", "clp"});
}

}  // namespace loop_run_test
}  // namespace fpc
