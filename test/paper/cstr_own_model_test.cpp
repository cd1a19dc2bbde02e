// From the reactor's own record to a model to control: excite, identify, run the experiments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "config/model_file.hpp"
#include "config/structure_file.hpp"
#include "fmbpc/model/model_match.hpp"
#include "identification/identify.hpp"
#include "paths.hpp"
#include "runtime/factory.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace paper_cstr_own_model_test {

TsModel identified(int seed, const std::string& excitation = "cstr_excite",
                   const std::string& structure_name = "cstr") {
  const LoopFile loop = readLoop(excitation, {{"seed", std::to_string(seed)}});
  const RunRecord record = runLoop(loop);
  const auto folder =
      std::filesystem::path(resultsDir()) / (excitation + "_" + std::to_string(seed));
  writeRun(loop, record, summarize(loop, record, 0.0), folder.string());
  const Structure structure =
      readStructure(sourceDir() + "/config/structure/" + structure_name + ".yaml");
  const DataSet data = makeDataSet(readCsv((folder / "trajectory.csv").string()), structure);
  EXPECT_TRUE(data.repairs.empty());
  TsModel model = identify(data, structure).model;
  std::ofstream((folder / "model.yaml").string()) << writeModel(model);
  return model;
}

struct Outcome {
  double score{};    ///< sum of (y_r - y)^2
  double largest{};  ///< |y_r - y|
  double last{};     ///< |y_r - y| at the end
};

Outcome runWith(const TsModel& model, const std::string& name, const Overrides& overrides = {}) {
  LoopFile loop = readLoop(name, overrides);
  loop.model = matchToPlant(model, loop.plant_info);
  const RunRecord record = runLoop(loop);
  Outcome outcome;
  outcome.score = summarize(loop, record, 0.0).outputs[0].ise_reference;
  for (const auto& sample : record.samples) {
    outcome.last = std::abs(sample.tracking.reference[0] - sample.measurement.outputs[0]);
    outcome.largest = std::max(outcome.largest, outcome.last);
  }
  return outcome;
}

class CstrOwnModel : public ::testing::TestWithParam<int> {};

TEST_P(CstrOwnModel, ControlsTheReactor) {
  SCOPED_TRACE("seed " + std::to_string(GetParam()));
  const TsModel model = identified(GetParam());
  const Outcome tracking = runWith(model, "cstr_tracking"),
                disturbance = runWith(model, "cstr_disturbance"),
                small = runWith(model, "cstr_small_steps");
  std::printf("seed %d: tracking %.5f, disturbance %.5f, small steps %.5f\n", GetParam(),
              tracking.score, disturbance.score, small.score);
  EXPECT_LE(tracking.score, 0.0050);
  EXPECT_LE(disturbance.score, 0.0036);
  for (const Outcome& outcome : {tracking, disturbance, small}) {
    EXPECT_LT(outcome.largest, 0.02) << "mol/l";
    EXPECT_LT(outcome.last, 0.001) << "mol/l";
  }
  const Overrides literal = {{"controller.realisation", "literal"}};
  const Outcome as_printed = runWith(model, "cstr_tracking", literal);
  std::printf("seed %d: tracking as printed %.5f\n", GetParam(), as_printed.score);
  EXPECT_LT(as_printed.largest, 0.04) << "does not diverge";
}

INSTANTIATE_TEST_SUITE_P(Seeds, CstrOwnModel, ::testing::Range(1, 9));

/// The rules of config/model/NAME.yaml are those of `model`.
void expectShipped(const TsModel& model, const std::string& name) {
  const TsModel shipped = readModel(sourceDir() + "/config/model/" + name + ".yaml");
  ASSERT_EQ(shipped.submodels[0].rules.size(), model.submodels[0].rules.size());
  for (std::size_t i = 0; i < model.submodels[0].rules.size(); ++i) {
    const Rule &a = shipped.submodels[0].rules[i], &b = model.submodels[0].rules[i];
    EXPECT_EQ(a.antecedents, b.antecedents);
    EXPECT_LT((a.coefficients - b.coefficients).norm(), 1e-6 * b.coefficients.norm()) << i;
    EXPECT_NEAR(a.offset, b.offset, 1e-6 * std::abs(b.offset)) << i;
  }
}

TEST(CstrOwnModelFile, IsTheOneOfTheFirstSeed) { expectShipped(identified(1), "cstr_own"); }

TEST(CstrLagsModelFile, IsTheOneOfTheFirstSeed) {
  expectShipped(identified(1, "cstr_excite_fast", "cstr_lags"), "cstr_lags");
}

double trackingUnder(const std::string& loop, const Overrides& overrides) {
  const LoopFile file = readLoop(loop, overrides);
  return summarize(file, runLoop(file), 0.0).outputs[0].ise_reference;
}

/// The row of config/study/cstr_mismatch.yaml: the aim of 1.5 times the 0.0034 of cstr_tracking
/// holds under every load; at another reaction rate it is missed, by less than with model A.
TEST(CstrLagsLoop, MeetsEveryLoadAndGainsAtBothRates) {
  const std::string load = "disturbance.nominal.d_q_c";
  for (const char* value : {"-6", "-3", "0", "3", "6"})
    EXPECT_LE(trackingUnder("cstr_tracking_lags", {{load, value}}), 0.0051) << value;
  for (const char* value : {"6.48e+10", "7.92e+10"}) {
    const Overrides rate = {{"plant.parameters.rate_constant", value}};
    EXPECT_LT(trackingUnder("cstr_tracking_lags", rate),
              trackingUnder("cstr_tracking_observer_lead", rate))
        << value;
  }
}

TEST(CstrRateModelFile, IsTheOneOfTheFirstSeed) {
  expectShipped(identified(1, "cstr_excite_rate", "cstr_rate"), "cstr_rate");
}

/// The aim of 1.5 times the 0.003383 of cstr_tracking holds under every load and at both rates.
TEST(CstrRateLoop, MeetsEveryLoadAndBothRates) {
  const double aim = 1.5 * trackingUnder("cstr_tracking", {});
  for (const char* value : {"-6", "-3", "0", "3", "6"})
    EXPECT_LE(trackingUnder("cstr_tracking_rate", {{"disturbance.nominal.d_q_c", value}}), aim)
        << value;
  for (const char* value : {"6.48e+10", "7.92e+10"})
    EXPECT_LE(trackingUnder("cstr_tracking_rate", {{"plant.parameters.rate_constant", value}}), aim)
        << value;
}

/// With models of other experiments: within 3 % of the aim at k0 - 10 %.
TEST(CstrRateLoop, DoesNotHangOnOneExperiment) {
  const double aim = 1.5 * trackingUnder("cstr_tracking", {});
  for (const int seed : {2, 3, 4}) {
    const TsModel model = identified(seed, "cstr_excite_rate", "cstr_rate");
    for (const char* value : {"6.48e+10", "7.92e+10"}) {
      LoopFile loop = readLoop("cstr_tracking_rate", {{"plant.parameters.rate_constant", value}});
      loop.model = matchToLoop(model, loop);
      const double found = summarize(loop, runLoop(loop), 0.0).outputs[0].ise_reference;
      EXPECT_LE(found, 1.03 * aim) << seed << " " << value;
    }
  }
}

/// Held back, and with a fallback where the reactor is out: neither a slow valve nor a reactor that
/// has gone out keeps it from coming back.
TEST(CstrRateLoop, ComesBackAfterAStuckValve) {
  for (const auto& [stuck_at, moves] : {std::pair("100", "20"), std::pair("130", "200")}) {
    const LoopFile loop = readLoop(
        "cstr_tracking_rate", {{"setpoint.schedule", "[]"},
                               {"sampling.duration_h", "1.25"},
                               {"actuator.move_upper.q_c", moves},
                               {"disturbance.commands",
                                "[{time_h: 0.4, name: input/q_c, value: " + std::string(stuck_at) +
                                    "}, {time_h: 0.475, name: input/q_c, mode: release}]"}});
    const RunRecord record = runLoop(loop);
    ASSERT_EQ(record.samples.size(), 751U);
    for (std::size_t k = 700; k <= 750; ++k)
      ASSERT_NEAR(record.samples[k].measurement.outputs[0], 0.15, 0.005) << stuck_at << ", " << k;
    EXPECT_TRUE(contains(summarize(loop, record, 0.0).events, EventCode::kReferenceHeldBack))
        << stuck_at;
  }
}

/// The law says what it takes load and rate for.
TEST(CstrRateLoop, SaysWhatLoadAndRateItFinds) {
  const LoopFile loop = readLoop("cstr_tracking_rate", {{"disturbance.nominal.d_q_c", "6"}});
  ControllerSession session = makeControllerSession(loop);
  session.setModel(loop.model);
  for (const SampleRecord& sample : runLoop(loop).samples) session.receive(sample.measurement);
  const auto signal = [&](const std::string& name) {
    for (const auto& [key, value] : session.controller().signals())
      if (key == name) return value;
    return std::nan("");
  };
  EXPECT_NEAR(signal("d_q_c_estimate"), 6.0, 1.5) << "l/min";
  EXPECT_NEAR(signal("rate_estimate"), 0.0, 3.0) << "%";
}

}  // namespace paper_cstr_own_model_test
}  // namespace fpc
