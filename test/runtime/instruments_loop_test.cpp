// Drives and instruments that the loop file names, in a model of the process alone.
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
