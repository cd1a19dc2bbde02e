// Drives and instruments that the loop file names, in a model of the process alone.
#include <algorithm>
#include <cmath>

#include "runtime/loop_fixture.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_instruments_loop_test {

double gainOf(const Rule& rule, const OutputModel& model) {
  double gain = 0.0;
  for (std::size_t i = 0; i < model.regressors.size(); ++i)
    if (model.regressors[i].kind == SignalKind::kInput)
      gain += rule.coefficients[static_cast<Eigen::Index>(i)];
  return gain;
}

TEST(ModelInstruments, TheGainsStayAndTheInputComesLater) {
  const LoopFile plain = readLoop("cstr_tracking_observer", {});
  const LoopFile slow = readLoop("cstr_tracking_observer",
                                 {{"actuator.lag.q_c.t90_s", "15"}, {"sensors.CA.t90_s", "12"}});
  const OutputModel &before = plain.model.submodels[0], &after = slow.model.submodels[0];
  EXPECT_GT(after.regressors.size(), before.regressors.size() + 3);
  for (std::size_t r = 0; r < before.rules.size(); ++r)
    EXPECT_NEAR(gainOf(after.rules[r], after), gainOf(before.rules[r], before), 1e-12);
  const LoopFile included = readLoop("cstr_tracking_observer", {{"actuator.lag.q_c.t90_s", "15"},
                                                                {"model.instruments", "included"}});
  EXPECT_EQ(included.model.submodels[0].regressors, before.regressors);
}

TEST(ModelInstruments, WhatLastsTooLongIsRefused) {
  expectWords(errorOf([] {
                readLoop("cstr_tracking_observer", {{"sensors.CA.t90_s", "3600"}});
              }),
              {"model.file", "instruments", "60 samples"});
}

double iseOf(const std::string& name, Overrides more) {
  const LoopFile loop = readLoop(name, more);
  return summarize(loop, runLoop(loop), 0.0).outputs[0].ise_reference;
}

TEST(ModelInstruments, AFastLawBearsThoseThatTheFileNames) {
  for (const Overrides& more :
       {Overrides{{"actuator.lag.q_c.t90_s", "5"}}, Overrides{{"sensors.CA.t90_s", "6"}}})
    for (const char* name : {"cstr_tracking_lags", "cstr_tracking_rate"})
      EXPECT_LT(iseOf(name, more), iseOf("cstr_tracking_pi_best", more)) << name;
}

/// The law that weighs moves, with valve, analyser and gear that neither file nor model has.
TEST(ModelInstruments, TheLawToBeginWithBearsThoseThatNobodyNames) {
  for (Overrides more : {Overrides{{"actuator.lag.q_c.t90_s", "5"}, {"sensors.CA.t90_s", "6"}},
                         Overrides{{"actuator.lag.q_c.t90_s", "10"}},
                         Overrides{{"actuator.lag.q_c.backlash", "4"}}}) {
    const double baseline = iseOf("cstr_tracking_pi_best", more);
    more.emplace_back("model.instruments", "included");
    EXPECT_LT(iseOf("cstr_tracking_robust", more), baseline) << more.front().first;
  }
}

bool growsIn(const RunRecord& run) {
  const auto grows = [](const Event& event) { return event.code == EventCode::kOscillationGrows; };
  return std::any_of(run.samples.begin(), run.samples.end(), [&](const SampleRecord& sample) {
    return std::any_of(sample.events.begin(), sample.events.end(), grows);
  });
}

Overrides noisy(double std, int seed, const Overrides& more) {
  Overrides all{{"noise.std.CA", std::to_string(std)}, {"seed", std::to_string(seed)}};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

/// A bold law swings further each time where nobody names the valve: the PI behind it acts then.
TEST(ModelInstruments, ABoldLawThatDoesNotBearThemIsTakenOff) {
  int found = 0, near = 0;
  constexpr int kRuns = 12;
  for (int seed = 51; seed < 51 + kRuns; ++seed) {
    Overrides more{{"actuator.lag.q_c.t90_s", "5"}};
    const auto iseUnder = [&](const std::string& name, bool& grows) {
      const LoopFile loop = readLoop(name, noisy(1e-4, seed, more));
      const RunRecord run = runLoop(loop);
      grows = growsIn(run);
      return summarize(loop, run, 0.0).outputs[0].ise;
    };
    bool grows = false;
    const double baseline = iseUnder("cstr_tracking_pi_best", grows);
    more.emplace_back("model.instruments", "included");
    const double watched = iseUnder("cstr_tracking_watched", grows);
    found += grows ? 1 : 0;
    near += watched <= 1.5 * baseline ? 1 : 0;
  }
  EXPECT_EQ(found, kRuns);
  EXPECT_GE(near, kRuns - 1);
}

TEST(ModelInstruments, ALawThatBearsThemIsLeftInPeace) {
  int found = 0;
  // the noise that the loop is made for, and five times it
  for (int seed = 101; seed < 141; ++seed)
    for (const double std : {1e-4, 5e-4})
      found += growsIn(runLoop(readLoop("cstr_tracking_watched", noisy(std, seed, {})))) ? 1 : 0;
  EXPECT_LE(found, 1) << "8 of 1,000 at five times the noise";
}

/// The first two pairs of setpoints.
TEST(ModelInstruments, TheReactorWithTwoInputsCarriesItsValves) {
  const auto costOf = [](const std::string& name, Overrides more) {
    more.emplace_back("sampling.duration_h", "0.95");
    const LoopFile loop = readLoop(name, more);
    const Summary summary = summarize(loop, runLoop(loop), 0.0);
    return summary.outputs[0].ise_reference + 5e-5 * summary.outputs[1].ise_reference;
  };
  const double baseline = costOf("mimo_cstr_lags_pi", {});
  EXPECT_LT(costOf("mimo_cstr_lags", {}), 1.1 * baseline);
  EXPECT_LT(costOf("mimo_cstr_lags", {{"clp.perturbation_steps", "20"}}), 1.1 * baseline);
}

}  // namespace loop_instruments_loop_test
}  // namespace fpc
