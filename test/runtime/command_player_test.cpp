// What an operator does, from a file, in a run in one process.
#include <gtest/gtest.h>

#include <array>

#include "config/command_file.hpp"
#include "events.hpp"
#include "fmbpc/base/text.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_command_player_test {

class Commands : public LoopFolder {
 protected:
  LoopFile loop(const std::string& name, Overrides overrides = {}) const {
    overrides.emplace_back("sampling.duration_h", "40");
    return readLoop(name, overrides);
  }
  std::vector<TimedCommand> commands(const std::string& entries, const LoopFile& loop) const {
    return readCommands(write("commands.yaml", "commands:\n" + entries), loop);
  }
  RunRecord run(const LoopFile& loop, const std::string& entries) {
    RunOptions options;
    options.commands = commands(entries, loop);
    options.said = [this](const Event& event) { said_.push_back(event); };
    return runLoop(loop, options);
  }
  std::vector<Event> said_;
};

void expectSameBits(const RunRecord& a, const RunRecord& b) {
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    EXPECT_EQ(a.samples[k].measurement.outputs, b.samples[k].measurement.outputs) << k;
    EXPECT_EQ(a.samples[k].measurement.input_applied, b.samples[k].measurement.input_applied) << k;
    EXPECT_EQ(a.samples[k].tracking.setpoint, b.samples[k].tracking.setpoint) << k;
  }
}

TEST_F(Commands, SetpointsAndDisturbancesActAsThoseOfTheLoopFile) {
  const RunRecord by_file =
      runLoop(loop("asp_case1", {{"setpoint.commands",
                                  "[{time_h: 5, name: x, value: 1900},"
                                  " {time_h: 12, name: x, mode: release}]"},
                                 {"disturbance.commands",
                                  "[{time_h: 4, name: q_i, value: 1900},"
                                  " {time_h: 10, name: input/q_r, mode: offset, value: 30}]"}}));
  const RunRecord by_hand = run(loop("asp_case1"),
                                "- {time_h: 12, setpoint: [x], mode: release}\n"
                                "- {time_h: 5, setpoint: {x: 1900}}\n"
                                "- {time_h: 4, disturbance: {q_i: 1900}}\n"
                                "- {time_h: 10, disturbance: {input/q_r: 30}, mode: offset}\n");
  expectSameBits(by_file, by_hand);
  EXPECT_EQ(by_hand.samples[25].tracking.setpoint[1], 1900.0);
}

TEST_F(Commands, ManualActsFromItsSampleOnAndReturnsWithoutABump) {
  const RunRecord record = run(loop("asp_case1"),
                               "- {time_h: 10, manual: true}\n"
                               "- {time_h: 12, manual_input: {q_r: 650}}\n"
                               "- {time_h: 20, manual: false}\n");
  const auto applied = [&](std::size_t k) {
    return record.samples[k + 1].measurement.input_applied[0];
  };
  EXPECT_EQ(record.samples[49].action.source, ActionSource::kBase);
  EXPECT_EQ(record.samples[50].action.source, ActionSource::kManual);
  EXPECT_EQ(applied(50), applied(49));
  for (std::size_t k = 60; k < 100; ++k) EXPECT_EQ(applied(k), 650.0) << k;
  EXPECT_EQ(record.samples[100].action.source, ActionSource::kBase);
  EXPECT_NEAR(applied(100), 650.0, 1e-6);
  EXPECT_TRUE(said_.empty());
}

TEST_F(Commands, WhatIsRefusedIsToldAndTheRunGoesOn) {
  const RunRecord record = run(loop("asp_case1"),
                               "- {time_h: 1, manual_input: {q_r: 650}}\n"
                               "- {time_h: 2, adapt: true}\n"
                               "- {time_h: 3, settings: {horizon_steps: 3}}\n");
  EXPECT_TRUE(record.complete);
  const std::vector<std::string> refused{"command_refused  5..5 (1)", "command_refused  10..10 (1)",
                                         "command_refused  15..15 (1)"};
  EXPECT_EQ(test::shown(said_), refused);
  EXPECT_EQ(test::shown(test::eventsOf(record)), refused);
  expectWords(said_[1].text, {"adapts"});
}

TEST_F(Commands, AnIdentificationWithoutItsSectionIsRefused) {
  for (const char* name : {"heated_tank", "asp_case1"}) {
    const RunRecord record =
        run(readLoop(name, {{"sampling.duration_h", "2"}}), "- {time_h: 1, identify: 10}\n");
    EXPECT_TRUE(record.complete) << name;
    EXPECT_EQ(test::codesOf(test::eventsOf(record)),
              std::vector<EventCode>{EventCode::kCommandRefused})
        << name;
  }
}

/// k Ts in hours, rounded as doubles and as nine decimals are, is sample k at any sample time.
TEST_F(Commands, ActAtTheSampleAtWhichAScheduleWould) {
  for (const double sample_time_s : {1.0 / 3.0, 30.0, 3600.0 / 7.0, 0.1}) {
    const LoopFile tank =
        readLoop("heated_tank", {{"sampling.sample_time_s", exactText(sample_time_s)},
                                 {"sampling.duration_h", exactText(100.0 * sample_time_s / 3600.0)},
                                 {"setpoint.schedule", "[]"},
                                 {"disturbance.commands", "[]"}});
    std::string entries;
    for (int k = 1; k <= 100; ++k) {
      const std::string when = "- {time_h: " + exactText(k * sample_time_s / 3600.0);
      entries += when + ", setpoint: {T: " + std::to_string(40 + k % 7) + "}}\n";
      entries += when + ", disturbance: {T_in: " + std::to_string(10 + k % 7) + "}}\n";
    }
    const RunRecord record = run(tank, entries);
    ASSERT_EQ(record.samples.size(), 101U);
    for (std::size_t k = 1; k <= 100; ++k) {
      const auto step = static_cast<double>(k % 7);
      EXPECT_EQ(record.samples[k].tracking.setpoint[0], 40.0 + step) << sample_time_s << " " << k;
      EXPECT_EQ(record.samples[k].state.disturbances[0], 10.0 + step) << sample_time_s << " " << k;
    }
  }
}

TEST_F(Commands, AClampedSetpointIsSaid) {
  const LoopFile tank = readLoop("heated_tank", {{"setpoint.upper.T", "60"}});
  const RunRecord record = run(tank,
                               "- {time_h: 1, setpoint: {T: 15}, mode: offset}\n"
                               "- {time_h: 1.5, setpoint: {T: 10}, mode: offset}\n"
                               "- {time_h: 2, setpoint: {T: 61}}\n"
                               "- {time_h: 2.5, setpoint: [T], mode: release}\n");
  EXPECT_EQ(record.samples[130].tracking.setpoint[0], 60.0);  // 50 + 15
  EXPECT_EQ(test::shown(test::eventsOf(record)),              // 1 to 1.5 h and 2 to 2.5 h
            std::vector<std::string>{"setpoint_clamped T 120..299 (120)"});
}

TEST_F(Commands, AScheduleBeyondTheLimitsOfTheFileIsSaidAsWell) {
  const LoopFile tank = readLoop("heated_tank", {{"setpoint.upper.T", "45"}});
  const RunRecord record = runLoop(tank);
  EXPECT_EQ(record.samples[40].tracking.setpoint[0], 45.0);
  EXPECT_EQ(test::shown(test::eventsOf(record)),  // 50 from 0.25 h on
            std::vector<std::string>{"setpoint_clamped T 30..359 (330)"});
}

TEST_F(Commands, WhatLiesBeyondTheRunIsTold) {
  const RunRecord record = run(loop("asp_case1"),
                               "- {time_h: 5, setpoint: {x: 1900}}\n"
                               "- {time_h: 40.1, setpoint: {x: 1950}}\n"
                               "- {time_h: 50, manual: true}\n");
  const std::vector<Event> events = summarize(loop("asp_case1"), record, 0.0).events;
  EXPECT_EQ(test::codesOf(events),
            (std::vector<EventCode>{EventCode::kBeyondRun, EventCode::kCommandsUnplayed}));
  expectWords(events[0].text, {"1 of 2", "80 h", "40 h"});
  expectWords(events[1].text, {"2 ", "40.1 h"});
}

TEST_F(Commands, SettingsAndHoldReachTheController) {
  const LoopFile tuned = readLoop("surge_tank_steps", {{"sampling.duration_h", "0.01"}});
  const RunRecord plain = runLoop(tuned);
  const RunRecord record = run(tuned, "- {time_h: 0.001, settings: {weight_move: '1e6'}}\n");
  EXPECT_TRUE(said_.empty()) << textOf(said_);
  bool differs = false;
  for (std::size_t k = 0; k + 1 < record.samples.size(); ++k)
    differs = differs || record.samples[k].action.input != plain.samples[k].action.input;
  EXPECT_TRUE(differs);
  const RunRecord held = run(loop("asp_case1"), "- {time_h: 20, hold: true}\n");
  EXPECT_EQ(held.samples[199].tracking.setpoint[1], 1800.0);  // 2200 from 30 h on
}

TEST_F(Commands, AModelIsUsedFromItsSampleOn) {
  const RunRecord plain = runLoop(loop("asp_case1"));
  const RunRecord record = run(loop("asp_case1"), "- {time_h: 20, model: asp_d.yaml}\n");
  for (std::size_t k = 0; k < 100; ++k)
    EXPECT_EQ(plain.samples[k].action.input, record.samples[k].action.input) << k;
  EXPECT_NE(plain.samples[101].action.input, record.samples[101].action.input);
}

TEST_F(Commands, ErrorsNameFileEntryAndWhatWasExpected) {
  const LoopFile plain = loop("asp_case1");
  for (const auto& [entry, word] : std::vector<std::pair<std::string, std::string>>{
           {"- {time_h: 1}\n", "one of setpoint, disturbance"},
           {"- {manual: true}\n", "time_h"},
           {"- {time_h: -1, manual: true}\n", "time_h"},
           {"- {time_h: 1, manual: true, hold: true}\n", "one of"},
           {"- {time_h: 1, setpoint: {z: 1}}\n", "z"},
           {"- {time_h: 1, setpoint: {x: .nan}}\n", "x"},
           {"- {time_h: 1, manual_input: {q_r: 1, q_s: 2}}\n", "q_s"},
           {"- {time_h: 1, model: nobody.yaml}\n", "nobody.yaml"},
           {"- {time_h: 1, setpont: {x: 1}}\n", "commands[0].setpont: unknown key"},
           {"- {time_h: 1, hold: true, mod: release}\n", "commands[0].mod: unknown key"},
           {"- {time_h: 2e6, manual: true}\n", "time_h"}})
    expectWords(errorOf([&, text = entry] { commands(text, plain); }), {"commands", word});
  const std::string slip = write("slip.yaml", "comands: []\n");
  expectWords(errorOf([&] { readCommands(slip, plain); }), {"slip.yaml:1", "comands", "commands"});
}

TEST_F(Commands, ValuesBeyondTheRangesAreRefusedWithTheirPlace) {
  const LoopFile tank = readLoop("heated_tank");
  for (const auto& [what, key, range] : std::vector<std::array<std::string, 3>>{
           {"setpoint: {T: 99999}", "setpoint.T", ">= 0 and <= 100 [degC]"},
           {"manual_input: {heat: 1e9}", "manual_input.heat", ">= 0 and <= 20 [kW]"},
           {"disturbance: {T_in: 1e9}", "disturbance.T_in", ">= 0 and <= 40 [degC]"},
           {"disturbance: {input/heat: -1}", "disturbance.input/heat", ">= 0 and <= 20 [kW]"}})
    expectWords(errorOf([&, text = what] {
                  commands("- {time_h: 0, manual: true}\n- {time_h: 1, " + text + "}\n", tank);
                }),
                {"commands.yaml:3", "commands[1]." + key, range});
  const LoopFile narrow = readLoop("heated_tank", {{"actuator.input_upper.heat", "10"}});
  commands("- {time_h: 1, disturbance: {input/heat: 10}}\n", narrow);
  expectWords(errorOf([&] { commands("- {time_h: 1, disturbance: {input/heat: 11}}\n", narrow); }),
              {"commands[0].disturbance.input/heat", "<= 10 [kW], the limits of the actuator"});
  commands("- {time_h: 1, setpoint: {T: 100}}\n- {time_h: 1, setpoint: {T: -300}, mode: offset}\n",
           tank);
  const LoopFile steady = readLoop("heated_tank", {{"setpoint.schedule", "[]"}});
  expectWords(errorOf([&] { commands("- {time_h: 1, hold: true}\n", steady); }),
              {"commands[0].hold", "setpoint.schedule"});
}

}  // namespace loop_command_player_test
}  // namespace fpc
