#include "runtime/identifier_session.hpp"
#include "events.hpp"

#include <gtest/gtest.h>

#include "fmbpc/base/signals.hpp"
#include "fmbpc/model/model_match.hpp"
#include "runtime/loop_fixture.hpp"
#include "runtime/run.hpp"

namespace fpc {
namespace loop_identifier_session_test {

/// What a run told of models.
struct Told {
  std::vector<TsModel> models;
  std::vector<Event> events;
  RunRecord record;
};

Told run(const LoopFile& loop) {
  Told told;
  RunOptions options;
  options.identified = [&](const TsModel& model) { told.models.push_back(model); };
  options.said = [&](const Event& event) { told.events.push_back(event); };
  told.record = runLoop(loop, options);
  return told;
}

TEST(IdentifierSession, SaysWhenToIdentifyAndThatOnce) {
  const LoopFile loop =
      readLoop("asp_identify", {{"sampling.duration_h", "30"}, {"model.identify.after", "100"}});
  LoopFile plain = loop;
  plain.has_identify = false;
  const RunRecord record = runLoop(plain);
  IdentifierSession session(loop);
  EXPECT_EQ(session.start(), nullptr);
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const auto due = session.take(record.samples[k].measurement);
    ASSERT_EQ(due.job.has_value(), k == 99) << k;
    if (!due.job) continue;
    EXPECT_EQ(due.job->values.rows(), 100);
    expectWords(due.job->source, {"activated_sludge", "samples up to 99"});
  }
  EXPECT_EQ(session.take(record.samples[100].measurement).arrival, Arrival::kOld);
}

TEST(IdentifierSession, AJobThatCannotBeMadeIsToldAndTheRunGoesOn) {
  const Told told = run(readLoop("asp_case1", {{"sampling.duration_h", "4"},
                                               {"model.identify.structure", "cstr.yaml"},
                                               {"model.identify.after", "5"}}));
  EXPECT_EQ(told.record.samples.size(), 21U);
  EXPECT_TRUE(told.models.empty());
  EXPECT_EQ(test::shown(test::eventsOf(told.record)),
            std::vector<std::string>{"identification_failed  5..5 (1)"});
}

TEST(IdentifierSession, WhatIsLearnedInVainDoesNotDrownOtherEvents) {
  const RunRecord record = run(readLoop("asp_case1", {{"sampling.duration_h", "24"},
                                                      {"model.identify.structure", "asp_d.yaml"},
                                                      {"model.identify.online.every", "1"},
                                                      {"model.max_pole", "0.9"}}))
                               .record;
  std::size_t entries = 0, refusals = 0;
  for (const Event& event : test::eventsOf(record)) {
    if (event.code != EventCode::kModelRefused) continue;
    ++entries;
    refusals += event.count;
  }
  EXPECT_EQ(entries, EventList::kMostTexts);  // later ones count into the last of them
  EXPECT_EQ(refusals, 66U);
}

TEST(IdentifierSession, AModelThatIsUnstableWhereThePlantIsIsRefusedAndTheOldOneStays) {
  const LoopFile loop =
      readLoop("asp_case1", {{"model.identify.online.every", "40"}, {"sampling.duration_h", "4"}});
  LoopFile plain = loop;
  plain.has_identify = false;
  const RunRecord record = runLoop(plain);
  IdentifierSession session(loop);
  ASSERT_NE(session.start(), nullptr);
  session.take(record.samples[0].measurement);
  TsModel wild = loop.model;
  for (OutputModel& submodel : wild.submodels)
    for (Rule& rule : submodel.rules) rule.coefficients *= 3.0;
  expectWords(errorOf([&] { session.accept(wild); }), {"pole"});
  EXPECT_EQ(session.refused(), 1U);
  EXPECT_EQ(session.published(), 1U);
  EXPECT_EQ(session.model().name, loop.model.name);
}

TEST(IdentifierSession, TheModelOfTheFileWaitsForWhatThePlantHasKept) {
  const LoopFile loop = readLoop("asp_case1");
  IdentifierSession session(loop);
  EXPECT_FALSE(session.startDue(100.0));  // nobody has announced a run
  session.announce(7, 100.0);
  session.announce(7, 100.8);  // the first time counts
  EXPECT_FALSE(session.startDue(100.9));
  EXPECT_TRUE(session.startDue(101.1));  // a plant that keeps nothing says nothing
  EXPECT_FALSE(session.hearKept({}));
  EXPECT_TRUE(session.startDue(100.9));
  session.start();
  EXPECT_FALSE(session.startDue(200.0));
  EXPECT_FALSE(session.hearKept({0, 7, 3}));  // there is one already

  IdentifierSession back(loop);
  back.announce(7, 100.0);
  EXPECT_TRUE(back.hearKept({0, 7, 3}));
  back.restore(loop.model);
  EXPECT_FALSE(back.startDue(200.0));

  IdentifierSession without(readLoop("asp_identify"));
  without.announce(7, 100.0);
  EXPECT_FALSE(without.startDue(200.0));
}

TEST(IdentifierSession, AKeptModelComesBackWithWhatTheControllerEstimates) {
  const LoopFile loop = readLoop("cstr_tracking_rate");
  const TsModel kept = asIdentified(loop.model);  // as topics carry it: all of them disturbances
  ASSERT_EQ(namesOf(kept.disturbances), (std::vector<std::string>{"d_q_c", "rate"}));
  IdentifierSession session(loop);
  session.announce(7, 100.0);
  ASSERT_TRUE(session.hearKept({0, 7, 3}));
  const TsModel& back = session.restore(kept);
  EXPECT_TRUE(back.disturbances.empty());
  EXPECT_EQ(namesOf(back.unmeasured), namesOf(loop.model.unmeasured));
}

TEST(IdentifierSession, WhatWasLearnedAndIsNotHandedOverSaysWhy) {
  LoopFile loop =
      readLoop("asp_case1", {{"model.identify.online.every", "40"}, {"sampling.duration_h", "20"}});
  LoopFile plain = loop;
  plain.has_identify = false;
  const RunRecord record = runLoop(plain);
  loop.max_pole = 0.01;
  IdentifierSession session(loop);
  session.start();
  for (std::size_t k = 0; k < record.samples.size(); ++k) {
    const auto due = session.take(record.samples[k].measurement);
    EXPECT_EQ(due.model, nullptr) << k;
    const bool refused = k > 0 && k % 40 == 0;
    EXPECT_EQ(due.refusal.find("a model that is stable") != std::string::npos, refused) << k;
    EXPECT_EQ(due.refusal.empty(), !refused) << k;
  }
  EXPECT_EQ(session.refused(), 2U);
}

TEST(Run, OnlineLearningChangesTheModelAtItsStatedSamples) {
  const Overrides learning{{"sampling.duration_h", "40"}, {"model.identify.online.every", "40"}};
  const Told plain = run(readLoop("asp_case1", {{"sampling.duration_h", "40"}}));
  const Told told = run(readLoop("asp_case1", learning));
  std::size_t first = 0;
  const auto& a = plain.record.samples;
  const auto& b = told.record.samples;
  while (first < 200 && a[first].action.input == b[first].action.input) ++first;
  EXPECT_EQ(first, 42U);  // learned from sample 40, taken over without a bump at 41
  const Told again = run(readLoop("asp_case1", learning));
  for (std::size_t k = 0; k < 200; ++k)
    ASSERT_EQ(b[k].action.input, again.record.samples[k].action.input) << k;
}

TEST(Run, IdentifiesByItselfAndHandsTheModelOver) {
  const LoopFile loop =
      readLoop("asp_identify", {{"sampling.duration_h", "90"}, {"model.identify.after", "400"}});
  const Told told = run(loop);
  ASSERT_EQ(told.models.size(), 1U) << textOf(told.events);
  expectWords(told.models[0].source, {"samples up to 399"});
}

}  // namespace loop_identifier_session_test
}  // namespace fpc
