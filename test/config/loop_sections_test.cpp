// What sections of a loop file become: options by their words, instruments, watches.
#include <gtest/gtest.h>

#include <cmath>

#include "control/fmbpc/law.hpp"
#include "runtime/loop_fixture.hpp"

namespace fpc {
namespace config_loop_sections_test {

/// A key that takes one of a few words.
struct OptionKey {
  std::string loop, key;
  std::vector<std::string> words;
};

void PrintTo(const OptionKey& option, std::ostream* stream) { *stream << option.key; }

class EveryOption : public ::testing::TestWithParam<OptionKey> {};

TEST_P(EveryOption, RefusesAnotherWordAndNamesItsOwn) {
  const OptionKey& option = GetParam();
  const std::string error =
      errorOf([&] { readLoop(option.loop, {parseOverride(option.key + "=nonsense")}); });
  expectWords(error, {option.key.substr(option.key.rfind('.') + 1)});
  for (const std::string& word : option.words) expectWords(error, {word});
}

const OptionKey kOptions[] = {
    {"asp_case1_clp", "clp.cost", {"least_perturbation", "lq"}},
    {"asp_case1_clp", "clp.bounds", {"absolute", "incremental"}},
    {"asp_case1_clp", "loop.pace", {"lockstep", "paced", "realtime"}},
    {"asp_case1_clp", "disturbance.source", {"constant", "pattern", "csv"}},
    {"asp_case1_clp", "plant.integrator.method", {"bdf", "adams", "runge_kutta"}},
    {"asp_case1_clp", "sensors.x.class", {"none", "A", "B0", "B1", "C0", "C1", "D"}},
    {"asp_case1_clp", "plausibility.signals.x.substitute", {"hold", "last_good", "model"}},
    {"asp_case1_pi_x", "controller.loops.0.anti_windup", {"none", "clamp", "tracking"}},
    {"asp_case1_pi_x", "controller.loops.0.start", {"bias", "bumpless"}},
    {"asp_excite", "controller.signals.0.signal", {"prbs", "multi_level", "steps", "none"}},
    {"asp_influent_csv", "disturbance.csv.time_unit", {"s", "min", "h", "d"}},
    {"asp_influent_csv", "disturbance.csv.missing", {"error", "hold", "interpolate"}},
    {"asp_influent_csv", "disturbance.csv.interpolation", {"hold", "linear"}},
    {"asp_influent_csv", "disturbance.csv.end", {"error", "hold", "repeat"}},
    {"batch_fuzzy_eq45", "controller.bound", {"cost", "reach"}},
    {"cstr_modbus", "gateway.type", {"none", "float64", "modbus"}},
    {"cstr_modbus", "gateway.modbus.word_order", {"high_first", "low_first"}}};

INSTANTIATE_TEST_SUITE_P(LoopSections, EveryOption, ::testing::ValuesIn(kOptions));

SensorParams sensorOf(const Overrides& set) {
  return readLoop("asp_case1_pi_x", set).simulation.instruments.sensors.at("x");
}

TEST(LoopSections, ASensorNeedsNoClass) {
  const SensorParams plain = sensorOf({{"sensors.x.noise_std", "2.5"}});
  EXPECT_EQ(plain.noise_std, 2.5);
  EXPECT_EQ(plain.lags, 0);
  EXPECT_EQ(sensorOf({{"sensors.x.class", "A"}}).lags, 2);
  EXPECT_EQ(sensorOf({{"sensors.x.class", "none"}}).lags, 0);
}

TEST(LoopSections, WhatSignalsMayBeIsKnownByDefault) {
  const LoopFile plain = readLoop("asp_case1_pi_x");
  for (const auto* group : {&plain.plausibility.outputs, &plain.plausibility.disturbances})
    for (const SignalPlausibility& signal : *group) {
      EXPECT_TRUE(signal.frozen);
      EXPECT_EQ(signal.repeated, group == &plain.plausibility.outputs)
          << "records of disturbances are often rounded";
    }
  EXPECT_THROW(readLoop("asp_case1_pi_x", {{"plausibility.signals.q_i.repeated", "true"}}),
               InputError);
  EXPECT_EQ(plain.plausibility.outputs[1].scale_upper, plain.plant_info.outputs[1].upper);
  EXPECT_FALSE(plain.plausibility.range_falls) << "an initial input is no fallback";
  EXPECT_TRUE(
      readLoop("asp_case1_pi_x", {{"actuator.fallback.q_r", "800"}}).plausibility.range_falls);
  const LoopFile slow = readLoop("asp_case1_pi_x", {{"sensors.x", "{range: [-.inf, 3000]}"}});
  EXPECT_EQ(slow.plausibility.outputs[1].scale_upper, 3000.0);
}

TEST(LoopSections, WhatStandstillWatchesIsItsOwnBusiness) {
  const auto frozen = [](const Overrides& more) {
    Overrides all{{"standstill.signals.x", "3"}};
    all.insert(all.end(), more.begin(), more.end());
    return readLoop("asp_case1_pi_x", all).plausibility.outputs[1].frozen;
  };
  EXPECT_FALSE(frozen({}));
  EXPECT_TRUE(frozen({{"standstill", "false"}}));
  EXPECT_TRUE(frozen({{"plausibility.signals.x.frozen", "true"}}));
}

TEST(LoopSections, AResolutionIsNoiseAndBringsAnObserver) {
  const LoopFile coarse = readLoop("surge_tank_steps", {{"sensors.H.resolution", "0.0006"}});
  EXPECT_NEAR(controllerContext(coarse).noise_std[0], 0.0006 / std::sqrt(12.0), 1e-15);
  EXPECT_TRUE(controllerContext(coarse).quantised);
  const auto realisation = [](const Overrides& more) {
    return readLoop("methanol_clip", more).controllerParams<FmbpcParams>().realisation;
  };
  EXPECT_EQ(realisation({}), FmbpcRealisation::kParallel);
  EXPECT_EQ(realisation({{"sensors.T_4.resolution", "0.1"}}), FmbpcRealisation::kObserver);
  EXPECT_EQ(
      realisation({{"sensors.T_4.resolution", "0.1"}, {"controller.realisation", "realigned"}}),
      FmbpcRealisation::kRealigned);
}

TEST(LoopSections, WatchesAreHandedOn) {
  const LoopFile plain = readLoop("asp_case1_pi_x");
  EXPECT_TRUE(plain.standstill.signals.empty());
  EXPECT_TRUE(plain.plausibility.enabled);
  EXPECT_EQ(plain.stuck.samples, 5);
  EXPECT_FALSE(plain.stuck.hold);
  EXPECT_TRUE(readLoop("example_external").stuck.hold);
  EXPECT_FALSE(readLoop("example_external", {{"plausibility.stuck", "say"}}).stuck.hold);
  EXPECT_FALSE(plain.gateway.enabled());
  const LoopFile watched = readLoop("asp_case1_pi_x", {{"standstill.signals.x", "3"}});
  ASSERT_EQ(watched.standstill.signals.size(), 1U);
  EXPECT_EQ(watched.standstill.signals[0].name, "x");
  EXPECT_EQ(watched.standstill.signals[0].least_change, 3.0);
  EXPECT_EQ(watched.standstill.signals[0].noise_std, 0.0);
  EXPECT_EQ(watched.standstill.noise_window_samples, 4 * watched.standstill.window_samples);
  EXPECT_EQ(watched.standstill.fallback, watched.simulation.actuator.initial);
  EXPECT_EQ(watched.standstill_fallback, nullptr);
  const LoopFile noisy =
      readLoop("asp_case1_pi_x", {{"standstill.signals.x", "3"},
                                  {"noise.std.x", "4"},
                                  {"sensors.x", "{noise_std: 6, average: true, interval_s: 180}"}});
  EXPECT_NEAR(noisy.standstill.signals[0].noise_std, 5.0, 1e-12) << "a mean of 4 readings";
  const LoopFile told = readLoop(
      "asp_case1_pi_x", {{"standstill.signals.x", "3"}, {"standstill.noise_window_h", "10"}});
  EXPECT_EQ(told.standstill.noise_window_samples, 50);
  const auto with = [](const std::string& fallback) {
    return readLoop("asp_case1_pi_x",
                    {{"standstill.signals.x", "3"}, {"standstill.fallback", fallback}});
  };
  const std::string loops =
      "loops: [{input: q_r, output: s, kp: 0, feedforward: [{disturbance: "
      "q_i, gain: 0.1}]}]";
  EXPECT_EQ(with("{type: pi, " + loops + "}").standstill_fallback->type().name, "pi");
  EXPECT_EQ(with("false").standstill_fallback, nullptr);
  EXPECT_THROW(with("{q_r: 800}"), InputError);
  EXPECT_THROW(with("{type: fmbpc}"), InputError);
  EXPECT_THROW(
      readLoop("asp_best_estimated",
               {{"standstill.signals.x", "3"},
                {"standstill.fallback", "{type: pi, loops: [{input: q_r, output: x_r, kp: 1}]}"}}),
      InputError);
  const LoopFile off =
      readLoop("asp_case1_pi_x", {{"standstill.signals.x", "3"}, {"standstill", "false"}});
  EXPECT_TRUE(off.standstill.signals.empty());
}

}  // namespace config_loop_sections_test
}  // namespace fpc
