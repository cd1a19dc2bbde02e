// Every loop file that ships can be read, and baselines run under the same conditions.
#include <gtest/gtest.h>

#include <algorithm>

#include "config/disturbance_source.hpp"
#include "control/fmbpc/law.hpp"
#include "runtime/factory.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_shipped_loops_test {

class ShippedLoop : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedLoop, IsRead) {
  if (needsRecords(GetParam()) && !hasRecords()) GTEST_SKIP() << "FMBPC_DATA is not set";
  const LoopFile loop = readLoop(GetParam());
  EXPECT_EQ(loop.name, GetParam());
  EXPECT_NE(loop.report.title, loop.name) << "a title for people";
  if (loop.external_plant) return;
  const Simulation simulation = makeSimulation(loop);
  EXPECT_EQ(simulation.info().outputs.size(), loop.plant_info.outputs.size());
  EXPECT_GT(loop.simulation.samples, 0U);
}

TEST_P(ShippedLoop, RefusesAWeightThatIsNoNumber) {
  EXPECT_THROW(readLoop(GetParam(), {{"controller.weight_output", ".nan"}}), InputError);
}

TEST_P(ShippedLoop, HasBaselinesUnderTheSameDisturbances) {
  const std::string name = GetParam();
  const auto cut = std::min(name.find("_pi"), name.find("_gspi"));
  if (cut == std::string::npos) return;
  if (needsRecords(name) && !hasRecords()) GTEST_SKIP() << "FMBPC_DATA is not set";
  const LoopFile baseline = readLoop(name), base = readLoop(name.substr(0, cut));
  EXPECT_EQ(makeDisturbance(baseline).values, makeDisturbance(base).values);
  EXPECT_EQ(baseline.setpoint.initial, base.setpoint.initial);
  ASSERT_EQ(baseline.setpoint.schedule.size(), base.setpoint.schedule.size());
  for (std::size_t i = 0; i < base.setpoint.schedule.size(); ++i) {
    EXPECT_EQ(baseline.setpoint.schedule[i].time_h, base.setpoint.schedule[i].time_h);
    const Vector &ours = baseline.setpoint.schedule[i].value,
                 &theirs = base.setpoint.schedule[i].value;
    EXPECT_TRUE((ours.array() == theirs.array() || ours.array().isNaN()).all());
  }
  const auto &commands = baseline.simulation.disturbance_commands,
             &of_base = base.simulation.disturbance_commands;
  ASSERT_EQ(commands.size(), of_base.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    EXPECT_EQ(commands[i].time_h, of_base[i].time_h);
    EXPECT_EQ(commands[i].command.value, of_base[i].command.value);
  }
  EXPECT_EQ(baseline.simulation.output_delay_s, base.simulation.output_delay_s);
  EXPECT_EQ(baseline.simulation.parameters, base.simulation.parameters);
  EXPECT_EQ(baseline.simulation.actuator.limits.upper, base.simulation.actuator.limits.upper);
  EXPECT_EQ(baseline.controllerType().name, "pi");
  EXPECT_FALSE(baseline.has_clp);
}

std::string nameOf(const ::testing::TestParamInfo<std::string>& loop) { return loop.param; }

INSTANTIATE_TEST_SUITE_P(Config, ShippedLoop, ::testing::ValuesIn(loopNames()), nameOf);

TEST(ShippedLoops, AreThere) { EXPECT_GE(loopNames().size(), 40U); }

TEST(ShippedLoops, CaseOneIsThatOfThePaper) {
  const LoopFile loop = readLoop("asp_case1");
  EXPECT_EQ(loop.model.name, "FM_1");
  const auto& law = loop.controllerParams<FmbpcParams>();
  EXPECT_EQ(law.law, FmbpcForm::kPublished);
  EXPECT_EQ(law.coincidence_steps, 6);
  EXPECT_EQ(law.reference_pole, (Vector(2) << 0.76, 0.96).finished());
  EXPECT_EQ(loop.simulation.samples, 830U);
  EXPECT_EQ(loop.simulation.actuator.limits.upper[0], 1600.0);
  EXPECT_EQ(loop.simulation.actuator.initial[0], 570.0);
  EXPECT_NEAR(makeDisturbance(loop).values.row(1).mean(), 430.0, 1e-9);
}

}  // namespace config_shipped_loops_test
}  // namespace fpc
