#include <gtest/gtest.h>

#include "fmbpc/base/input_error.hpp"
#include "plant/simulation.hpp"
#include "plant/simulation_fixture.hpp"

namespace fpc {
namespace plant_simulation_commands_test {

const Vector kU = one(570.0);

TEST(SimulationCommands, NamesAreDisturbancesInputsAndOutputs) {
  const Simulation simulation(sludgeParams());
  EXPECT_EQ(simulation.commandNames(),
            (std::vector<std::string>{"q_i", "s_i", "input/q_r", "output/s", "output/x"}));
}

TEST(SimulationCommands, WithoutAStampTheyActFromTheNextMeasuredSample) {
  Simulation simulation(sludgeParams());
  simulation.advance(kU);
  EXPECT_EQ(simulation.command(command("q_i", 1900.0)), 2U);
  EXPECT_EQ(simulation.measurement().disturbances[0], 1300.0);
  EXPECT_TRUE(simulation.effects().empty());
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 1900.0);
  ASSERT_EQ(simulation.effects().size(), 1U);
  EXPECT_EQ(simulation.effects()[0].header.step, 2U);
  EXPECT_EQ(simulation.effects()[0].command.name.front(), "q_i");
  simulation.advance(kU);
  EXPECT_TRUE(simulation.effects().empty());
  EXPECT_EQ(simulation.measurement().disturbances[0], 1900.0);
}

TEST(SimulationCommands, AStampMeansTheFirstSampleNotBeforeIt) {
  Simulation simulation(sludgeParams());
  Command later = command("q_i", 1900.0);
  later.time_ns = simulation.clock().timeAt(5) - 1;
  EXPECT_EQ(simulation.command(later), 5U);
  Command past = command("s_i", 100.0);
  past.time_ns = 1;
  EXPECT_EQ(simulation.command(past), 1U);
  for (std::uint32_t k = 1; k <= 6; ++k) {
    const Measurement& m = simulation.advance(kU);
    EXPECT_EQ(m.disturbances[0], k < 5 ? 1300.0 : 1900.0) << k;
    EXPECT_EQ(m.disturbances[1], 100.0) << k;
  }
}

// k Ts in hours is no binary number for most k: no sample may be lost by that.
TEST(SimulationCommands, AScheduledTimeOfASampleIsThatSample) {
  for (const double sample_time_s : {360.0, 1.0 / 3.0}) {
    SimulationParams p = sludgeParams(3000);
    p.sample_time_s = sample_time_s;
    for (std::uint32_t k = 1; k <= 3000; k += 7)
      p.disturbance_commands.push_back({k * sample_time_s / 3600.0, command("q_i", 1000.0 + k)});
    Simulation simulation(p);
    for (std::uint32_t k = 1; k <= 100; ++k) {
      const double last = 1000.0 + (k - (k - 1) % 7);
      EXPECT_EQ(simulation.advance(kU).disturbances[0], last) << sample_time_s << " " << k;
    }
  }
}

TEST(SimulationCommands, ADisturbanceActsOnThePlantFromItsSampleOn) {
  Simulation told(sludgeParams());
  told.command(command("q_i", 1900.0));
  SimulationParams p = sludgeParams();
  p.disturbance.values = p.disturbance_nominal.replicate(1, 21);
  p.disturbance.values.row(0).tail(20).setConstant(1900.0);
  Simulation recorded(p);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(told.advance(kU).outputs, recorded.advance(kU).outputs);
}

TEST(SimulationCommands, OffsetsFollowTheRecordAndReleaseReturnsToIt) {
  SimulationParams p = sludgeParams();
  p.disturbance = rampRecord(20);
  Simulation simulation(p);
  simulation.command(command("q_i", 100.0, CommandMode::kOffset));
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 1401.0);
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 1402.0);
  EXPECT_EQ(simulation.scheduledDisturbances()[0], 1302.0);  // without it
  simulation.command({0, {"q_i"}, {}, CommandMode::kRelease});
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 1303.0);
}

TEST(SimulationCommands, UnmeasuredDisturbancesActUnseen) {
  SimulationParams p = sludgeParams();
  p.measured_disturbances.clear();
  Simulation simulation(p);
  simulation.command(command("s_i", 900.0));
  simulation.advance(kU);
  EXPECT_EQ(simulation.measurement().disturbances.size(), 0);
  EXPECT_EQ(simulation.state().disturbances[1], 900.0);
}

TEST(SimulationCommands, ScheduledOnesActAtTheirTimeInEveryRun) {
  SimulationParams p = sludgeParams();
  p.disturbance_commands = {{0.0, command("q_i", 1000.0)}, {0.6, command("q_i", 2000.0)}};
  Simulation simulation(p);
  for (std::uint64_t run = 2; run < 4; ++run) {
    EXPECT_EQ(simulation.measurement().disturbances[0], 1000.0) << "at sample 0 already";
    EXPECT_EQ(simulation.effects().size(), 1U);
    for (int k = 1; k <= 4; ++k)
      EXPECT_EQ(simulation.advance(kU).disturbances[0], k < 3 ? 1000.0 : 2000.0) << k;
    simulation.reset(run);
  }
}

TEST(SimulationCommands, ResetReleasesWhatPeopleSent) {
  Simulation simulation(sludgeParams());
  simulation.command(command("q_i", 1900.0));
  simulation.command(command("input/q_r", 0.0));
  simulation.advance(kU);
  simulation.reset(2);
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 1300.0);
  EXPECT_EQ(simulation.measurement().input_applied, kU);
}

TEST(SimulationCommands, AStuckValveIsSeenInThePositionFeedback) {
  Simulation simulation(sludgeParams());
  simulation.command(command("input/q_r", 200.0));
  EXPECT_EQ(simulation.advance(kU).input_applied, kU) << "u(0) was before the fault";
  EXPECT_EQ(simulation.advance(kU).input_applied, one(200.0));
  EXPECT_EQ(simulation.state().actuator_clips, 0U) << "the command itself was fine";
  SimulationParams p = sludgeParams();
  Simulation really(p);
  really.advance(kU);
  really.advance(one(200.0));
  EXPECT_EQ(simulation.measurement().outputs, really.measurement().outputs);
  simulation.command({0, {"input/q_r"}, {}, CommandMode::kRelease});
  simulation.advance(kU);
  EXPECT_EQ(simulation.advance(kU).input_applied, kU);
}

TEST(SimulationCommands, AFaultyValveStaysInsideItsBounds) {
  Simulation simulation(sludgeParams());
  for (const double value : {1e9, -1e9, 1e308}) {
    for (const auto mode : {CommandMode::kOverride, CommandMode::kOffset}) {
      simulation.command(command("input/q_r", value, mode));
      simulation.advance(kU);
      const double applied = simulation.advance(kU).input_applied[0];
      EXPECT_EQ(applied, value > 0.0 ? 1600.0 : 0.0);
    }
  }
}

TEST(SimulationCommands, AnOffsetOnTheValveDoesNotAddUpWhenActionsAreMissing) {
  Simulation simulation(sludgeParams());
  simulation.command(command("input/q_r", 50.0, CommandMode::kOffset));
  simulation.advance(kU);
  for (int k = 0; k < 5; ++k)
    EXPECT_EQ(simulation.advanceWithoutAction().input_applied, one(620.0));
}

TEST(SimulationCommands, ASensorFaultChangesWhatIsShownAndNothingElse) {
  Simulation faulty(sludgeParams()), sound(sludgeParams());
  faulty.command(command("output/x", 1.0));
  faulty.command(command("output/s", 10.0, CommandMode::kOffset));
  for (int k = 0; k < 5; ++k) {
    faulty.advance(kU);
    sound.advance(kU);
    EXPECT_EQ(faulty.measurement().outputs[1], 1.0);
    EXPECT_EQ(faulty.measurement().outputs[0], sound.measurement().outputs[0] + 10.0);
    EXPECT_EQ(faulty.state().outputs, sound.measurement().outputs);
    EXPECT_EQ(faulty.state().state, sound.state().state);
  }
}

TEST(SimulationCommands, BadCommandsAreErrorsAndNothingIsTaken) {
  Simulation simulation(sludgeParams());
  EXPECT_THROW(simulation.command(command("q_r", 1.0)), InputError);
  EXPECT_THROW(simulation.command(command("q_i", kNaN)), InputError);
  EXPECT_THROW(simulation.command(command("q_i", -1.0)), InputError);
  EXPECT_THROW(simulation.command(command("s_i", 1e6)), InputError);
  EXPECT_THROW(simulation.command(command("q_i", -1e300, CommandMode::kOffset)), InputError);
  EXPECT_THROW(simulation.command(command("s_i", 1e300, CommandMode::kOffset)), InputError);
  EXPECT_THROW(simulation.command({0, {"q_i", "s_i"}, {1000.0, 1e6}}), InputError);
  EXPECT_THROW(simulation.command({0, {"q_i", "s_i"}, {1000.0}}), InputError);
  EXPECT_THROW(simulation.command(command("q_i", 1.0, static_cast<CommandMode>(0))), InputError);
  EXPECT_EQ(simulation.advance(kU).disturbances, Eigen::Vector2d(1300.0, 366.67));
}

TEST(SimulationCommands, OffsetsNeverTakeADisturbanceOutOfItsRange) {
  Simulation simulation(sludgeParams());
  simulation.command(command("q_i", -5000.0, CommandMode::kOffset));
  EXPECT_EQ(simulation.advance(kU).disturbances[0], 0.0);
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(simulation.advance(kU).outputs.allFinite());
  EXPECT_EQ(simulation.trouble(), "");
}

/// What was asked in vain at the present sample, by signal.
std::vector<std::string> clamped(const Simulation& simulation) {
  std::vector<std::string> signals;
  for (const Event& event : simulation.events()) signals.push_back(event.signal);
  return signals;
}

TEST(SimulationCommands, AnInputAskedBeyondItsLimitsIsSaidUntilItIsReleased) {
  using Names = std::vector<std::string>;
  Simulation simulation(sludgeParams());
  const InputLimits& limits = simulation.actuator().params().limits;
  const double range = limits.upper[0] - limits.lower[0];
  const auto after = [&](const Command& command) {
    simulation.command(command);
    simulation.advance(kU);
    return clamped(simulation);
  };
  EXPECT_EQ(after(command("input/q_r", limits.upper[0])), Names{});
  EXPECT_EQ(after(command("input/q_r", -range, CommandMode::kOffset)), Names{});
  EXPECT_EQ(after(command("output/x", 1e300)), Names{});
  EXPECT_EQ(after(command("input/q_r", 1e300)), Names{"input/q_r"});
  EXPECT_EQ(simulation.events()[0].code, EventCode::kInputClamped);
  simulation.advance(kU);
  EXPECT_EQ(clamped(simulation), Names{"input/q_r"});
  EXPECT_EQ(after(command("input/q_r", 1.1 * range, CommandMode::kOffset)), Names{"input/q_r"});
  EXPECT_EQ(after({0, {"input/q_r"}, {}, CommandMode::kRelease}), Names{});
  EXPECT_EQ(after(command("input/q_r", 1e300)), Names{"input/q_r"});
  simulation.reset(2);
  EXPECT_EQ(clamped(simulation), Names{});
}

TEST(SimulationCommands, AnOffsetOutOfTheRangeOfADisturbanceIsSaidWhileItActs) {
  using Names = std::vector<std::string>;
  SimulationParams params = sludgeParams(4);
  Simulation simulation(params);
  const double room =
      simulation.state().disturbances[0] - simulation.description().disturbances[0].lower;
  const auto after = [&](const Command& command) {
    simulation.command(command);
    simulation.advance(kU);
    return clamped(simulation);
  };
  EXPECT_EQ(after(command("q_i", -room, CommandMode::kOffset)), Names{}) << "on the bound";
  EXPECT_EQ(after(command("q_i", -room - 0.5, CommandMode::kOffset)), Names{"q_i"});
  EXPECT_EQ(simulation.events()[0].code, EventCode::kDisturbanceClamped);
  EXPECT_EQ(after(command("q_i", 1500.0)), Names{}) << "an override takes its place";
  EXPECT_EQ(after(command("q_i", -room - 0.5, CommandMode::kOffset)), Names{})
      << "nothing acts on the final sample";
}

}  // namespace plant_simulation_commands_test
}  // namespace fpc
