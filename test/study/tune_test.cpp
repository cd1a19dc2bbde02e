// Tuning of a cheap loop: better on what it has not seen, the same bits on any number of threads
// and after a stop, the budget to the run, failures that do not win.
#include "study/tune.hpp"

#include <atomic>
#include <cmath>
#include <sstream>

#include "config/extending_loop.hpp"
#include "control/pi/pi.hpp"
#include "paths.hpp"
#include "runtime/run.hpp"
#include "study/fitness.hpp"
#include "study/study_plan.hpp"
#include "study/tuning_fixture.hpp"

namespace fpc {
namespace study_tune_test {

class Tune : public LoopFolder {
 protected:
  TuningObjective objective(const std::string& tuning, int threads = 1) const {
    return {write("lag.yaml", lagLoop()), parseTuning(tuning, "t.yaml"), {}, threads};
  }
  static SearchParams search(const std::string& method = "apso") {
    SearchParams params;
    params.method = searchMethod(method);
    params.population = 8;
    params.evaluations = 60;
    return params;
  }
};

void expectSame(const TuneResult& one, const TuneResult& other) {
  ASSERT_EQ(one.history.size(), other.history.size());
  for (std::size_t i = 0; i < one.history.size(); ++i) {
    EXPECT_EQ(one.history[i].shares, other.history[i].shares) << i;
    EXPECT_EQ(one.history[i].values, other.history[i].values) << i;
    EXPECT_EQ(one.history[i].cost, other.history[i].cost) << i;
    EXPECT_EQ(one.history[i].scenarios, other.history[i].scenarios) << i;
  }
  EXPECT_EQ(one.best, other.best);
}

TEST_F(Tune, ImprovesTheScoreOnScenariosItHasNotSeen) {
  const TuningObjective judge = objective(lagTuning(), 0);
  for (const auto& method : searchMethods()) {
    const TuneResult tuned = tune(judge, search(method));
    ASSERT_GE(tuned.best, 0);
    const TuningStep& best = tuned.history[static_cast<std::size_t>(tuned.best)];
    const auto held = judge.judgeHeldOut(best.shares);
    EXPECT_LT(held->cost, 0.5 * judge.untouchedHeldOut().cost) << method;
    EXPECT_EQ(tuned.history.size(), 60U);
    EXPECT_EQ(tuned.failures, 0);
  }
}

TEST_F(Tune, ATermCountsAboveItsThresholdAndInItsScenario) {
  const auto cost = [&](const std::string& more) {
    std::string text = lagTuning();
    const std::string from = "- {index: effort, input: u, weight: 0.1}";
    const auto score = objective(text.replace(text.find(from), from.size(), more)).untouched();
    return score.scenarios;
  };
  const auto plain = cost("- {index: effort, input: u, weight: 0}");
  const auto all = cost("- {index: effort, input: u}");
  const double effort = all[0] - plain[0];
  ASSERT_GT(effort, 0.0);
  const std::string half = std::to_string(0.5 * effort);
  EXPECT_NEAR(cost("- {index: effort, input: u, above: " + half + "}")[0] - plain[0], 0.5 * effort,
              1e-5 * effort);
  EXPECT_EQ(cost("- {index: effort, input: u, above: " + std::to_string(2.0 * effort) + "}")[0],
            plain[0]);
  const auto second = cost("- {index: effort, input: u, scenario: seed 2}");
  EXPECT_EQ(second[0], plain[0]);
  EXPECT_EQ(second[1], all[1]);
}

/// Of a plant whose gain is between half and twice that of the loop file.
std::string uncertain(const std::string& scenarios) {
  std::string text = lagTuning("");
  const auto from = text.find("scenarios:"), to = text.find("search:");
  text.replace(from, to - from, scenarios);
  return text.replace(text.find("fitness:\n"), 9, "fitness:\n  across: worst\n");
}

const char* const kGain = "vary: {plant.matrix.elements.0.gain: [0.5, 2]}";

TEST_F(Tune, AnEnsembleHasThePlantsOfAStudyWithItsSeeds) {
  const std::string seeds = std::string("seeds: 1:5, ") + kGain;
  const TuningObjective judge = objective(uncertain("scenarios: {" + seeds + "}\n"));
  const StudyPlan plan(parseStudy("loops: [" + path("lag.yaml") + "]\nseeds: 1:5\n" + kGain +
                                      "\nfitness: {terms: [{index: ise}]}\n",
                                  "s.yaml"));
  for (std::size_t i = 0; i < 5; ++i) {
    const LoopFile loop = plan.loop(i);
    EXPECT_EQ(judge.untouched().scenarios[i], fitness(judge.tuning().fitness, loop, runLoop(loop)));
  }
}

TEST_F(Tune, GainsTunedOverAnEnsembleAreBetterAtItsWorstPlant) {
  const std::string all = std::string("held_out: {seeds: 1:12, ") + kGain + "}\n";
  const auto worst = [&](const std::string& scenarios) {
    const TuningObjective judge = objective(uncertain(scenarios + all), 0);
    const TuneResult tuned = tune(judge, search());
    return judge.judgeHeldOut(tuned.history[static_cast<std::size_t>(tuned.best)].shares)->cost;
  };
  EXPECT_LT(worst(std::string("scenarios: {seeds: 1:12, ") + kGain + "}\n"),
            worst("scenarios: {seeds: 1:12}\n"));
}

TEST_F(Tune, AnEffluentIsAskedOnlyOfAPlantThatHasOne) {
  std::string text = lagTuning();
  text.replace(text.find("{index: ise, output: y}"), 23, "{index: EQI}");
  try {
    objective(text);
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("BSM1"), std::string::npos) << error.what();
  }
}

TEST_F(Tune, APlantThatCannotBeMovedIsAFailureWithItsSample) {
  const std::string stuck = write("stuck.yaml",
                                  "extends: asp_case1_pi_x\nsampling: {duration_h: 4}\n"
                                  "plant: {integrator: {max_steps: 1}}\n");
  const TuningObjective judge(stuck,
                              parseTuning("parameters:\n"
                                          "  - {key: controller.loops.0.kp, lower: 0.1, upper: 5}\n"
                                          "fitness: {terms: [{index: ise}]}\n"
                                          "scenarios: {seeds: [1]}\n",
                                          "t.yaml"),
                              {}, 1);
  EXPECT_EQ(judge.untouched().failures, 1);
  EXPECT_NE(judge.untouched().trouble.find("sample 0: more integration"), std::string::npos)
      << judge.untouched().trouble;
}

TEST_F(Tune, GivesTheSameBitsOnOneTwoAndFourThreads) {
  for (const auto& method : searchMethods()) {
    const TuneResult one = tune(objective(lagTuning(), 1), search(method));
    expectSame(one, tune(objective(lagTuning(), 2), search(method)));
    expectSame(one, tune(objective(lagTuning(), 4), search(method)));
  }
}

TEST_F(Tune, GoesOnAfterAStopWithTheSameBits) {
  const TuningObjective judge = objective(lagTuning(), 2);
  for (const auto& method : searchMethods()) {
    const TuneResult whole = tune(judge, search(method));
    TuneOptions options;
    options.state = path(method + ".json");
    std::atomic<int> calls{0};
    options.stop = [&] { return ++calls > 1500; };  // asked once a sample
    const TuneResult part = tune(judge, search(method), options);
    EXPECT_TRUE(part.stopped);
    ASSERT_GT(part.history.size(), 0U);
    ASSERT_LT(part.history.size(), 60U);
    options.stop = {};
    options.resume = true;
    const TuneResult rest = tune(judge, search(method), options);
    EXPECT_EQ(rest.resumed, static_cast<int>(part.history.size()));
    expectSame(whole, rest);
    expectSame(whole, tune(judge, search(method), options));  // finished: nothing is run again
  }
}

TEST_F(Tune, AStateOfAnotherTuningIsRefused) {
  const TuningObjective judge = objective(lagTuning());
  TuneOptions options;
  options.state = path("state.json");
  options.resume = true;
  expectWords(errorOf([&] { tune(judge, search(), options); }), {"state.json", "readable"});
  options.resume = false;
  tune(judge, search(), options);
  options.resume = true;
  SearchParams other = search();
  other.seed = 2;
  expectWords(errorOf([&] { tune(judge, other, options); }), {"state.json", "this tuning"});
  const TuningObjective changed = objective(lagTuning() + "title: another\n");
  expectWords(errorOf([&] { tune(changed, search(), options); }), {"this tuning"});
  write("state.json", "{]");
  expectWords(errorOf([&] { tune(judge, search(), options); }), {"state of a tuning"});
}

// A model or record that was changed in the meantime must not be mixed with what was judged before.
TEST_F(Tune, TheFingerprintCoversWhatTheNamedFilesHold) {
  const auto fingerprint = [&](double flow, double gain) {
    write("load.csv", "t[h],q\n0,1300\n1," + std::to_string(flow) + "\n2,1300\n");
    std::ifstream shipped(sourceDir() + "/config/model/fm_1.yaml");
    write("own.yaml", std::string((std::istreambuf_iterator<char>(shipped)), {}) + "# " +
                          std::to_string(gain) + "\n");
    const std::string loop =
        write("load.yaml",
              "extends: asp_case1\nsampling: {duration_h: 2}\nmodel: {file: own.yaml}\n"
              "disturbance:\n  source: csv\n  csv: {file: load.csv, time_column: t, end: hold,\n"
              "        channels: {q_i: {column: q}}}\n");
    const std::string tuning =
        "parameters: [{key: controller.reference_pole.x, lower: 0.5, upper: 0.9}]\n"
        "fitness: {terms: [{index: ise}]}\n";
    return TuningObjective(loop, parseTuning(tuning, "t.yaml"), {}, 1).fingerprint();
  };
  const std::string first = fingerprint(1400.0, 1.0);
  EXPECT_EQ(fingerprint(1400.0, 1.0), first);
  EXPECT_NE(fingerprint(1401.0, 1.0), first);
  EXPECT_NE(fingerprint(1400.0, 2.0), first);
}

TEST_F(Tune, TheTunedFileRunsWithTheCostThatWasFound) {
  const TuningObjective judge = objective(lagTuning());
  const TuneResult tuned = tune(judge, search());
  const TuningStep& best = tuned.history[static_cast<std::size_t>(tuned.best)];
  const std::string text =
      extendingLoop(path("lag.yaml"), judge.changes(best.shares), "One lag, tuned", "by a test");
  EXPECT_EQ(text.rfind("# by a test\nextends: ", 0), 0U) << text;
  const std::string file = write("lag_tuned.yaml", text);
  for (const char* seed : {"1", "2"}) {
    const LoopFile loop = readLoop(file, {{"seed", seed}});
    EXPECT_EQ(loop.controllerParams<PiParams>().loops.front().kp, best.values[0]);
    const double cost = fitness(judge.tuning().fitness, loop, runLoop(loop));
    EXPECT_EQ(cost, best.scenarios[static_cast<std::size_t>(seed[0] - '1')]);
  }
}

TEST_F(Tune, WhatTheFileSetsIsInEveryRunAndInTheTunedLoop) {
  const TuningObjective judge = objective(lagTuning("set: {setpoint.initial.y: 2}\n"));
  EXPECT_GT(judge.untouched().cost, 3.0 * objective(lagTuning()).untouched().cost);
  const auto changes = judge.changes(judge.start());
  ASSERT_EQ(changes.size(), 3U);
  EXPECT_EQ(changes[0], (std::pair<std::string, std::string>{"setpoint.initial.y", "2"}));
}

TEST_F(Tune, ARunThatFailsCostsWhatTheFileSaysAndCannotWin) {
  std::string text = lagTuning();
  const std::string ki = "{key: controller.loops.0.ki_per_h, lower: 0.1, upper: 100, scale: log}";
  text.replace(text.find(ki), ki.size(), "{key: noise.std.y, lower: -0.002, upper: 0.002}");
  text.replace(text.find("fitness:\n"), 9, "fitness:\n  failure: 77\n");
  const TuneResult tuned = tune(objective(text), search("random"));
  double worst = 0.0;
  for (const auto& step : tuned.history) worst = std::max(worst, step.cost);
  EXPECT_EQ(worst, 77.0);
  EXPECT_GT(tuned.failures, 0);
  EXPECT_NE(tuned.trouble.find("noise.std.y"), std::string::npos) << tuned.trouble;
  EXPECT_LT(tuned.history[static_cast<std::size_t>(tuned.best)].cost, 10.0);
}

TEST_F(Tune, RelativeCostsAreOneForTheUntouchedLoop) {
  std::string text = lagTuning();
  text.replace(text.find("fitness:\n"), 9, "fitness:\n  relative: true\n  across: worst\n");
  const TuningObjective judge = objective(text);
  EXPECT_EQ(judge.untouched().cost, 1.0);
  const auto scores = judge.judge(judge.start());
  EXPECT_NEAR(scores->front().cost, 1.0, 1e-9);  // a logarithm back and forth
  ASSERT_EQ(scores->front().scenarios.size(), 2U);
}

TEST_F(Tune, BeginsAtTheNumbersOfTheLoopOrInTheMiddle) {
  const TuningObjective judge = objective(lagTuning());
  EXPECT_NEAR(judge.values(judge.start())[0], 0.2, 1e-12);
  EXPECT_NEAR(judge.values(judge.start())[1], 0.5, 1e-12);
  const std::string text =
      "parameters: [{key: setpoint.rate_per_h.y, lower: 1, upper: 3}]\n"
      "fitness: {terms: [{index: ise}]}\n";
  const TuningObjective middle = objective(text);
  EXPECT_EQ(middle.values(middle.start())[0], 2.0);
}

TEST_F(Tune, MistakesOfKeySignalAndSeedAreNamed) {
  const auto error = [&](const std::string& from, const std::string& to) {
    std::string text = lagTuning();
    text.replace(text.find(from), from.size(), to);
    return errorOf([&] { objective(text); });
  };
  expectWords(error("loops.0.kp", "loops.0.gain"), {"controller.loops[0].gain"});
  expectWords(error("loops.0.kp", "loops.1.kp"), {"controller.loops.1.kp"});
  expectWords(error("output: y", "output: z"), {"fitness.terms[0]", "one of y", "'z'"});
  std::string calm = lagLoop();
  calm.erase(calm.find("noise:"), calm.find("controller:") - calm.find("noise:"));
  expectWords(errorOf([&] {
                const TuningFile tuning = parseTuning(lagTuning(), "t.yaml");
                TuningObjective(write("calm.yaml", calm), tuning, {}, 1);
              }),
              {"seed 1", "noise or vary", "calm"});
  expectWords(error("scenarios: {seeds: [1, 2]}", "scenarios: [{loop: nothing}]"), {"nothing"});
}

TEST_F(Tune, HistoryHoldsEveryEvaluationExactly) {
  const TuningObjective judge = objective(lagTuning());
  const TuneResult tuned = tune(judge, search());
  writeHistory(judge.tuning(), tuned, path("history.csv"));
  std::ifstream stream(path("history.csv"));
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line,
            "evaluation,cost,best,controller.loops.0.kp,controller.loops.0.ki_per_h,cost of seed "
            "1,cost of seed 2");
  std::size_t rows = 0;
  for (; std::getline(stream, line); ++rows) {
    std::stringstream cells(line);
    std::string number, cost;
    std::getline(cells, number, ',');
    std::getline(cells, cost, ',');
    EXPECT_EQ(std::stod(cost), tuned.history[rows].cost);
  }
  EXPECT_EQ(rows, 60U);
}

}  // namespace study_tune_test
}  // namespace fpc
