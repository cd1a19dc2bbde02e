// A candidate beside the law in charge: it costs that law nothing, and what is handed over is what
// was judged. The study in part; bench/handover_study runs the whole of it.
#include "runtime/watched_law.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "bench/handover_study.hpp"
#include "fmbpc/base/signals.hpp"
#include "paths.hpp"
#include "runtime/loops_of_type.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace runtime_watched_law_test {

constexpr std::uint32_t kSamples = 25;

/// Inputs and outputs over the first samples.
Matrix courseOf(const LoopFile& file, std::uint32_t samples) {
  Simulation plant = makeSimulation(file);
  ControllerSession controller = makeControllerSession(file);
  if (controller.controller().needsModel()) controller.setModel(file.model);
  plant.reset(1);
  Matrix course(countOf(file.plant_info.outputs) + countOf(file.plant_info.inputs), samples);
  for (std::uint32_t k = 0; k < samples; ++k) {
    const Measurement now = plant.measurement();
    controller.receive(now);
    const Vector& input = controller.answer().base.input;
    course.col(k) << now.outputs, input;
    plant.advance(input);
  }
  return course;
}

/// Same bits, where nothing is a number too.
bool sameCourse(const Matrix& a, const Matrix& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

TEST(WatchedLaw, ACandidateThatIsOnlyWatchedCostsTheLawInChargeNoBit) {
  int looked = 0;
  for (const std::string& name : loopNames()) {
    LoopFile file = readLoop(name, withoutRecords(name));
    const bool enough = file.simulation.samples == 0 || file.simulation.samples > kSamples;
    if (file.external_plant || !file.has_model || !enough) continue;
    if (!makeControllerSession(file).controller().followsSetpoint()) continue;
    const Matrix alone = courseOf(file, kSamples);
    LoopFile candidate = file;
    bench::scaleInputs(candidate.model, 2.0, nullptr);  // another law than that in charge
    file.candidate.loop = std::make_shared<const LoopFile>(candidate);
    EXPECT_TRUE(sameCourse(alone, courseOf(file, kSamples))) << name;
    ++looked;
  }
  EXPECT_GT(looked, 60);
}

class Study : public ::testing::TestWithParam<int> {
 protected:
  const bench::StudyPlant& plant() const {
    return bench::studyPlants()[static_cast<std::size_t>(GetParam())];
  }
  bench::CaseResult run(bench::Spoil spoil, std::uint64_t seed) const {
    return bench::runCase(sourceDir(), plant(), spoil, seed);
  }
};

TEST_P(Study, NoSpoiltCandidateIsHandedOver) {
  for (const bench::Spoil spoil : bench::spoils()) {
    const bench::CaseResult r = run(spoil, 901);
    EXPECT_FALSE(r.handed_over) << plant().name << ", " << bench::nameOf(spoil) << r.report;
  }
}

TEST_P(Study, ARightCandidateIsHandedOverWithoutABumpAndStays) {
  int kept = 0;
  for (const std::uint64_t seed : {901, 902, 903}) {
    const bench::CaseResult r = run(bench::Spoil::kNone, seed);
    kept += r.state == CandidateState::kInCharge;
    EXPECT_LE(r.bump, 1.0) << plant().name << " " << seed;
  }
  EXPECT_GE(kept, 2) << plant().name;
}

TEST_P(Study, ALawThatSwingsIsTakenBackAndTheVarianceIsAsBefore) {
  if (plant().name != std::string("column") && plant().name != std::string("reactor"))
    GTEST_SKIP() << "ten times the PI's gain swings there within what was promised";
  const bench::CaseResult r = run(bench::Spoil::kSwings, 1);
  ASSERT_TRUE(r.handed_over) << plant().name << r.report;
  EXPECT_EQ(r.state, CandidateState::kBack) << plant().name << r.report;
  EXPECT_LE(r.bump_back, 1.0 + 1e-9) << plant().name;
  EXPECT_LT(r.after_back, 1.5) << plant().name;
}

INSTANTIATE_TEST_SUITE_P(Plants, Study, ::testing::Range(0, 4));

/// The tank of the study with its right candidate.
LoopFile tank(bool automatic) {
  LoopFile loop =
      bench::makeCase(sourceDir(), bench::studyPlants()[0], bench::Spoil::kNone, 901).loop;
  loop.candidate.params.automatic = automatic;
  return loop;
}

std::vector<Event> eventsOf(const RunRecord& record, EventCode code) {
  std::vector<Event> found;
  for (const SampleRecord& sample : record.samples)
    for (const Event& event : sample.events)
      if (event.code == code) found.push_back(event);
  return found;
}

TEST(WatchedLaw, EveryDecisionIsAnEventWithItsSample) {
  const RunRecord record = runLoop(tank(true));
  const auto watched = eventsOf(record, EventCode::kCandidateWatched);
  const auto passed = eventsOf(record, EventCode::kCandidatePassed);
  const auto steps = eventsOf(record, EventCode::kHandOver);
  ASSERT_EQ(watched.size(), 1U);
  EXPECT_EQ(watched[0].first, 0U);
  ASSERT_EQ(passed.size(), 1U);
  EXPECT_GE(passed[0].first, 200U);
  ASSERT_EQ(steps.size(), 3U);  // a quarter, a half, all of the allowed moves
  EXPECT_EQ(steps[0].first, passed[0].first);
  EXPECT_EQ(steps[1].first, steps[0].first + 51);
  EXPECT_EQ(steps[2].first, steps[1].first + 50);
  EXPECT_TRUE(eventsOf(record, EventCode::kHandBack).empty());
}

TEST(WatchedLaw, AnOperatorHandsOverAndTakesBack) {
  const LoopFile loop = tank(false);
  const double hours = loop.simulation.sample_time_s / 3600.0;
  RunOptions options;
  std::vector<std::string> refused;
  options.said = [&](const Event& event) {
    if (event.code == EventCode::kCommandRefused) refused.push_back(event.text);
  };
  options.commands = {{10 * hours, HandOver{true}},   // it has not passed
                      {20 * hours, HandOver{false}},  // nor is it in charge
                      {1000 * hours, HandOver{true}},
                      {1010 * hours, HandOver{false}}};
  const RunRecord record = runLoop(loop, options);
  EXPECT_EQ(refused.size(), 2U);
  ASSERT_EQ(eventsOf(record, EventCode::kCandidatePassed).size(), 1U);
  const auto over = eventsOf(record, EventCode::kHandOver),
             back = eventsOf(record, EventCode::kHandBack);
  ASSERT_EQ(over.size(), 1U);
  EXPECT_EQ(over[0].first, 1000U);
  ASSERT_EQ(back.size(), 1U);
  EXPECT_EQ(back[0].first, 1010U);
}

TEST(WatchedLaw, WhatCannotBeJudgedIsRefusedWithItsReason) {
  const std::string folder = sourceDir() + "/examples/handover/";
  const auto errorOfSet = [&](const std::string& file, const Overrides& set) {
    return errorOf([&] { readLoop(folder + file, set); });
  };
  expectWords(errorOfSet("tank.yaml", {{"candidate.loop", folder + "tank.yaml"}}),
              {"tank.yaml", "model.file", "candidate"});
  expectWords(errorOfSet("tank.yaml", {{"candidate.loop", folder + "furnace_candidate.yaml"}}),
              {"furnace_candidate.yaml", "inputs", "heat"});
  expectWords(errorOfSet("tank.yaml", {{"candidate.loop", "tank_candidat"}}), {"tank_candidat"});
}

TEST(WatchedLaw, ALoopThatExtendsTheOneInChargeMayBeItsCandidate) {
  const std::string folder = sourceDir() + "/examples/handover/";
  const LoopFile loop =
      readLoop(folder + "tank.yaml", {{"candidate.loop", folder + "tank_candidate.yaml"}});
  ASSERT_NE(loop.candidate.loop, nullptr);
  EXPECT_EQ(loop.candidate.loop->name, "tank_candidate");
  EXPECT_EQ(loop.candidate.loop->candidate.loop, nullptr);
  EXPECT_EQ(parseLoop(loop.resolved, "printed").candidate.loop->name, "tank_candidate");
}

}  // namespace runtime_watched_law_test
}  // namespace fpc
