// Studies of a cheap loop: paired cases, the same bits on any number of threads and after a stop,
// failures by kind, statistics known on paper.
#include "study/study.hpp"

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>

#include "plant/transfer_matrix.hpp"
#include "runtime/report.hpp"
#include "runtime/run.hpp"
#include "study/study_statistics.hpp"
#include "study/tuning_fixture.hpp"

namespace fpc {
namespace study_study_test {

class Study : public LoopFolder {
 protected:
  Study() { write("lag.yaml", lagLoop()); }
  /// A good PI and the badly tuned one.
  StudyPlan plan(const std::string& more = "seeds: 1:4\n") const {
    const std::string loop = path("lag.yaml");
    return StudyPlan(
        parseStudy("loops:\n  - {loop: " + loop +
                       ", name: good, set: {controller.loops.0.kp: 1}}\n  - {loop: " + loop +
                       ", name: bad}\nfitness: {terms: [{index: ise}]}\n" + more,
                   "s.yaml"));
  }
};

double gainOf(const LoopFile& loop) {
  const auto plant = makePlant(loop.simulation);
  return dynamic_cast<const TransferMatrixPlant&>(*plant).matrix().elements[0].gain;
}

void expectSame(const StudyResult& one, const StudyResult& other) {
  ASSERT_EQ(one.runs.size(), other.runs.size());
  for (std::size_t i = 0; i < one.runs.size(); ++i) {
    ASSERT_TRUE(one.runs[i] && other.runs[i]) << i;
    EXPECT_EQ(one.runs[i]->cost, other.runs[i]->cost) << i;
    EXPECT_EQ(one.runs[i]->move, other.runs[i]->move) << i;
    EXPECT_EQ(one.runs[i]->failures, other.runs[i]->failures) << i;
  }
}

TEST_F(Study, PairsSeeTheSameNoiseAndTheSamePlant) {
  const StudyPlan study = plan("seeds: 1:4\nvary: {plant.matrix.elements.0.gain: [0.5, 1.5]}\n");
  ASSERT_EQ(study.runs(), 8U);
  std::set<double> drawn;
  for (std::size_t c = 0; c < 4; ++c) {
    const LoopFile good = study.loop(c), bad = study.loop(4 + c);
    EXPECT_EQ(good.simulation.noise_seed, c + 1);
    EXPECT_EQ(bad.simulation.noise_seed, c + 1);
    const double gain = gainOf(good);
    EXPECT_EQ(gain, gainOf(bad));
    EXPECT_GE(gain, 1.0);  // 2 times 0.5..1.5
    EXPECT_LE(gain, 3.0);
    drawn.insert(gain);
  }
  EXPECT_EQ(drawn.size(), 4U);
}

TEST(StudyPlanOf, EveryStudyThatShipsCanBeMade) {
  if (!std::getenv("FMBPC_DATA")) GTEST_SKIP() << "FMBPC_DATA is not set";
  for (const auto& name : studyNames()) EXPECT_NO_THROW(StudyPlan{readStudy(name)}) << name;
}

TEST_F(Study, CostIsThatOfTheRunWithoutItsNoise) {
  const StudyPlan study = plan();
  const StudyResult result = runStudy(study);
  const RunRecord record = runLoop(study.loop(2));
  double ise = 0.0;
  for (const auto& sample : record.samples)
    ise += std::pow(sample.tracking.setpoint[0] - sample.state.outputs[0], 2);
  EXPECT_NEAR(result.runs[2]->cost, ise, 1e-12 * ise);
}

TEST_F(Study, TheBetterLoopWinsEveryPair) {
  const StudyPlan study = plan("seeds: 1:8\n");
  const StudyStatistics statistics = statisticsOf(study, runStudy(study));
  ASSERT_EQ(statistics.pairs.size(), 1U);
  EXPECT_EQ(statistics.pairs[0].wins, 8.0);
  EXPECT_LT(statistics.pairs[0].ratio_upper, 1.0);
  EXPECT_GT(statistics.pairs[0].lower, 0.5);
}

TEST_F(Study, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAStop) {
  const StudyPlan study = plan("seeds: 1:6\n");
  const StudyResult whole = runStudy(study, {1, "", false, {}, {}});
  expectSame(whole, runStudy(study, {4, "", false, {}, {}}));
  std::atomic<int> done{0};
  StudyOptions options{1, path("state.json"), false, [&] { return done >= 5; }, {}};
  options.progress = [&](std::size_t n, std::size_t) { done = static_cast<int>(n); };
  const StudyResult stopped = runStudy(study, options);
  EXPECT_FALSE(stopped.complete);
  const StudyResult resumed = runStudy(study, {1, path("state.json"), true, {}, {}});
  EXPECT_EQ(resumed.resumed, 5U);
  EXPECT_TRUE(resumed.complete);
  expectSame(whole, resumed);
  const StudyPlan other = plan("seeds: 2:7\n");
  expectWords(errorOf([&] {
                runStudy(other, {1, path("state.json"), true, {}, {}});
              }),
              {"state.json", "of this study"});
}

TEST_F(Study, FailuresAreCountedByKind) {
  // The plant cannot reach 20 with inputs up to 5 and gain 2: the input stays at its bound.
  const StudyPlan locked = plan(
      "seeds: 1\nset: {plant.matrix.outputs.0.upper: 30, setpoint.schedule: [{time_h: 0.2, y: "
      "20}]}\n");
  const StudyResult result = runStudy(locked);
  const auto count = [&](const StudyResult& r, RunFailure kind) {
    return r.runs[0]->failures[static_cast<std::size_t>(kind)];
  };
  EXPECT_EQ(count(result, RunFailure::kDiverged), 0U);
  // y still approaches 10 while the input stands at 5, so that is no lock-up ...
  EXPECT_EQ(count(result, RunFailure::kLocked), 0U);
  // ... but a law of the wrong sign runs away from its setpoint and stays there.
  const StudyPlan wrong = plan("seeds: 1\nset: {controller.loops.0.reverse: true}\n");
  EXPECT_GT(count(runStudy(wrong), RunFailure::kLocked), 20U);
  EXPECT_EQ(count(runStudy(plan("seeds: 1\n")), RunFailure::kLocked), 0U);
  // The same record with an input that stood there from the first sample on: nobody drove it.
  RunRecord record = runLoop(wrong.loop(0));
  const LoopFile loop = wrong.loop(0);
  EXPECT_GT(lockedSamples(loop, record, 0), 20U);
  const Vector bound = record.samples.back().measurement.input_applied;
  for (SampleRecord& sample : record.samples) sample.measurement.input_applied = bound;
  EXPECT_EQ(lockedSamples(loop, record, 0), 0U);
  const StudyPlan bounded = plan("seeds: 1\nset: {report.output_upper: {y: 0.1}}\n");
  EXPECT_GT(count(runStudy(bounded), RunFailure::kViolated), 10U);
}

TEST_F(Study, ARunThatCannotBeMadeIsADivergedOneWithItsWords) {
  const StudyPlan study = plan("seeds: 1:2\nvary: {noise.std.y: {values: [-1, -0.5]}}\n");
  const StudyStatistics statistics = statisticsOf(study, runStudy(study));
  EXPECT_EQ(statistics.loops[0].failures[0], 2U);
  expectWords(statistics.loops[0].trouble, {"noise.std", ">= 0"});
  EXPECT_EQ(statistics.pairs[0].wins, 1.0);  // two draws
}

TEST_F(Study, ARunWithoutACostSaysWhy) {
  const StudyPlan study(
      parseStudy("loops: [{loop: cstr_tracking_pi}]\nfitness: {terms: [{index: ise}]}\n"
                 "set: {plant.integrator.max_steps: 2, sampling.duration_h: 0.1}\n",
                 "s.yaml"));
  const StudyStatistics statistics = statisticsOf(study, runStudy(study));
  EXPECT_TRUE(noneSucceeded(statistics.loops[0]));
  expectWords(statistics.loops[0].trouble, {"sample 0", "integration"});
}

TEST_F(Study, OutputsWithoutASetpointHaveNoCost) {
  const StudyPlan study(
      parseStudy("loops: [{loop: asp_best}]\nseeds: 1\nfitness: {terms: [{index: ise}]}\n"
                 "set: {sampling.duration_h: 4}\n",
                 "s.yaml"));
  const StudyResult result = runStudy(study);
  EXPECT_EQ(result.runs[0]->trouble, "");
  EXPECT_GT(result.runs[0]->cost, 0.0);
  EXPECT_TRUE(std::isfinite(result.runs[0]->cost));
  const auto named = [](const std::string& name) {
    return parseStudy(
        "loops: [{loop: asp_best}]\nseeds: 1\nfitness: {terms: [{index: ise, output: " + name +
            "}]}\n",
        "s.yaml");
  };
  EXPECT_NO_THROW(StudyPlan(named("x")));
  expectWords(errorOf([&] { StudyPlan{named("x_r")}; }), {"fitness.terms[0]", "x_r", "s, x"});
}

TEST_F(Study, OutsideTheModelIsCountedAsTheLawSawIt) {
  const StudyPlan study(
      parseStudy("loops: [{loop: asp_best}]\nseeds: 1\nfitness: {terms: [{index: ise}]}\n"
                 "set: {sampling.duration_h: 10, noise.std.x: 600}\n",
                 "s.yaml"));
  const LoopFile loop = study.loop(0);
  const RunRecord record = runLoop(loop);
  const std::uint64_t seen = summarize(loop, record, 0.0).outside_model;
  EXPECT_GT(seen, 0U);
  EXPECT_LT(summarize(loop, withoutNoise(record), 0.0).outside_model, seen);
  const auto kind = static_cast<std::size_t>(RunFailure::kOutOfModel);
  EXPECT_EQ(runStudy(study).runs[0]->failures[kind], seen);
}

TEST_F(Study, ChangedRecordsAndModelsMakeAnotherStudy) {
  const auto record = [&](const char* value) {
    return write("d.csv", std::string("t[h],v\n0,15\n10,") + value + "\n");
  };
  const std::string csv =
      "{file: " + record("16") + ", time_column: t, end: hold, channels: {T_in: {column: v}}}";
  const auto study = [&](const std::string& more) {
    return StudyPlan(
               parseStudy("loops: [{loop: heated_tank}]\nfitness: {terms: [{index: ise}]}\n" + more,
                          "s.yaml"))
        .fingerprint();
  };
  const std::string by_set = "set: {disturbance: {source: csv, csv: " + csv + "}}\n";
  const std::string by_scenario =
      "scenarios: [{name: a, set: {disturbance: {source: csv, csv: " + csv + "}}}]\n";
  const std::string set = study(by_set), scenario = study(by_scenario), plain = study("");
  EXPECT_EQ(study(by_set), set);
  record("17");
  EXPECT_NE(study(by_set), set);
  EXPECT_NE(study(by_scenario), scenario);
  EXPECT_EQ(study(""), plain);
  const auto model = [&](const std::string& file) {
    return StudyPlan(parseStudy("loops: [{loop: asp_case1, set: {model.file: " + file +
                                    "}}]\nseeds: 1\nfitness: {terms: [{index: ise}]}\n",
                                "s.yaml"))
        .fingerprint();
  };
  std::ifstream own(configFolders().back() + "/model/fm_1.yaml");
  const std::string text((std::istreambuf_iterator<char>(own)), {});
  const std::string before = model(write("m.yaml", text));
  EXPECT_NE(model(write("m.yaml", text + "# changed\n")), before);
}

TEST_F(Study, NoiseOfNoOutputIsRefusedBeforeTheRuns) {
  expectWords(errorOf([&] { plan("seeds: 1\nnoise: {z: 0.1}\n"); }), {"noise.z", "one of y"});
}

TEST_F(Study, NoiseInPercentIsThatOfTheSpanOfTheSetpoints) {
  const LoopFile loop = plan("seeds: 1\nnoise: {percent_of_span: 2}\n").loop(0);
  EXPECT_NEAR(loop.simulation.noise_std[0], 0.02 * 0.5, 1e-12);  // setpoints 1 and 0.5
}

TEST_F(Study, WhatWouldVaryNothingIsRefusedBeforeTheRuns) {
  const std::string resting = "set: {setpoint.initial.y: 0, setpoint.schedule: []}\n";
  expectWords(errorOf([&] { plan("seeds: 1:2\nnoise: {percent_of_span: 2}\n" + resting); }),
              {"noise.percent_of_span", "the setpoint of y", "rests at 0"});
  expectWords(
      errorOf([&] { plan("seeds: 1:2\nvary: {setpoint.initial.y: [0.5, 2]}\n" + resting); }),
      {"vary.setpoint.initial.y", "value:LOWER:UPPER", "is 0"});
  plan("seeds: 1:2\nvary: {setpoint.initial.y: {values: [0.5, 2]}}\n" + resting);
}

TEST_F(Study, CasesWithTheSameTrajectoryAreRefusedWhateverTheReason) {
  const std::string quiet = "seeds: 1:3\nset: {noise.std.y: 0}\n";
  const StudyPlan same = plan(quiet + "vary: {plant.matrix.inputs.0.upper: [0.8, 1.2]}\n");
  StudyOptions options;
  options.state = path("same.json");
  for (options.resume = false;; options.resume = true) {
    expectWords(errorOf([&] { runStudy(same, options); }),
                {"loop good", "'seed 1' and 'seed 2'", "same trajectory"});
    if (options.resume) break;
  }
  EXPECT_TRUE(runStudy(plan(quiet + "vary: {controller.loops.0.kp: [0.5, 2]}\n")).complete);
}

TEST_F(Study, KeysWithoutANumberAndSeedsWithoutUseAreRefused) {
  expectWords(errorOf([&] { plan("seeds: 1\nvary: {plant.parameters.k: [1, 2]}\n"); }),
              {"vary.plant.parameters.k", "number"});
  expectWords(errorOf([&] { plan("seeds: 1\nvary: {noise.std.y: {values: [1, 1]}}\n"); }),
              {"vary", "lower < upper of noise.std.y", "got 1 and 1"});
  expectWords(errorOf([&] { plan("seeds: 1\nset: {noise.std: 0}\n"); }),
              {"seeds", "noise or vary"});
}

TEST(StudyStatistics, IntervalsAreThoseOfTheBooks) {
  // newcombe1998, table I: 81 of 263 by the score method: 0.2553 to 0.3662.
  const Interval share = wilsonInterval(81, 263, 0.95);
  EXPECT_NEAR(share.lower, 0.2553, 5e-5);
  EXPECT_NEAR(share.upper, 0.3662, 5e-5);
  EXPECT_EQ(wilsonInterval(0, 8, 0.95).lower, 0.0);  // not a rounding of it
  EXPECT_EQ(wilsonInterval(8, 8, 0.95).upper, 1.0);
  // n = 10: the 2nd and the 9th value hold the median with 97.9 %, the 3rd and 8th only with 89 %.
  const std::vector<double> ten{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_EQ(medianInterval(ten, 0.95).lower, 2.0);
  EXPECT_EQ(medianInterval(ten, 0.95).upper, 9.0);
  EXPECT_EQ(medianInterval(ten, 0.85).lower, 3.0);
  // The whole range of 5 holds the median with 93.75 % only, of 6 with 96.9 %.
  EXPECT_EQ(casesForMedianInterval(0.95), 6U);
  EXPECT_EQ(casesForMedianInterval(0.9), 5U);
  EXPECT_TRUE(std::isnan(medianInterval({1, 2, 3, 4, 5}, 0.95).lower));
  EXPECT_TRUE(std::isnan(medianInterval({}, 0.95).upper));
  EXPECT_EQ(medianInterval({1, 2, 3, 4, 5, 6}, 0.95).lower, 1.0);
  EXPECT_EQ(medianInterval({1, 2, 3, 4, 5}, 0.9).upper, 5.0);
}

}  // namespace study_study_test
}  // namespace fpc
