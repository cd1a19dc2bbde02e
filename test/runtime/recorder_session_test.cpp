#include "runtime/recorder_session.hpp"
#include "events.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace loop_recorder_session_test {

StepHeader header(std::uint32_t step, std::uint64_t run = 7) { return {1000 + step, run, step}; }

Measurement measurement(std::uint32_t step, bool final = false, std::uint64_t run = 7) {
  Measurement m;
  m.header = header(step, run);
  m.outputs = Vector::Constant(1, step);
  m.disturbances = Vector(0);
  m.input_applied = Vector::Zero(1);
  m.final = final;
  return m;
}

Tracking tracking(std::uint32_t step) { return {header(step), Vector::Ones(1), Vector::Ones(1)}; }
PlantState state(std::uint32_t step) {
  PlantState s;
  s.header = header(step);
  s.outputs = Vector::Ones(1);
  return s;
}
ControlAction action(std::uint32_t step) {
  return {header(step), Vector::Ones(1), ActionSource::kBase};
}
SolverReport report(std::uint32_t step) {
  SolverReport r;
  r.header = header(step);
  r.perturbation = Vector::Zero(1);
  return r;
}

class RecorderSessionTest : public ::testing::Test {
 protected:
  RecorderSession recorder(bool has_optimizer = false, bool has_state = false) {
    RecordLayout layout;
    layout.info.outputs = {{"y", "-", 0, 1}};
    layout.info.inputs = {{"u", "-", 0, 1}};
    layout.has_optimizer = has_optimizer;
    layout.has_state = has_state;
    return {layout, [this](std::uint32_t step, const SampleRecord& s) {
              passed_.push_back(s);
              steps_.push_back(step);
            }};
  }
  static void addSample(RecorderSession& r, std::uint32_t step, bool final = false) {
    r.receive(measurement(step, final));
    r.receive(tracking(step));
    if (!final) r.receiveBase(action(step));
  }
  std::vector<SampleRecord> passed_;
  std::vector<std::uint32_t> steps_;  // of them
};

TEST_F(RecorderSessionTest, IsCompleteWithTheFinalSampleAndNoGap) {
  RecorderSession r = recorder();
  r.announce(7);
  EXPECT_FALSE(r.complete());
  addSample(r, 0);
  addSample(r, 1);
  EXPECT_FALSE(r.complete());
  EXPECT_EQ(r.samples(), 2U);
  addSample(r, 2, true);
  EXPECT_TRUE(r.finalSeen() && r.complete());
  ASSERT_EQ(passed_.size(), 3U);
  EXPECT_TRUE(passed_[0].has_base && passed_[0].has_action);
  EXPECT_EQ(passed_[2].measurement.outputs[0], 2.0);
}

TEST_F(RecorderSessionTest, OrderOfArrivalDoesNotMatterAndEachGoesOutOnceItIsWhole) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 2, true);
  addSample(r, 0);
  EXPECT_EQ(r.gaps(), (std::vector<std::string>{"sample 1: no measurement", "sample 1: no tracking",
                                                "sample 1: no control_action"}));
  addSample(r, 1);
  EXPECT_TRUE(r.complete());
  EXPECT_EQ(steps_, (std::vector<std::uint32_t>{2, 0, 1}));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(passed_[i].measurement.header.step, steps_[i]);
}

TEST_F(RecorderSessionTest, HoldsASampleWhenAllOfItIsThere) {
  RecorderSession r = recorder();
  r.announce(7);
  r.receive(measurement(1));
  r.receiveBase(action(1));
  EXPECT_FALSE(r.holds(header(1)));
  r.receive(tracking(1));
  EXPECT_TRUE(r.holds(header(1)));  // though sample 0 has not come
  EXPECT_FALSE(r.holds(header(0)) || r.holds(header(2)) || r.holds(header(1, 8)));
  addSample(r, 0);
  EXPECT_TRUE(r.holds(header(0)) && r.holds(header(1)));
  r.resume(9, 5);
  EXPECT_TRUE(r.holds(header(4, 9)));  // on disk since before
}

TEST_F(RecorderSessionTest, AFinalSampleBeforeTheLoopsLastIsNotTheEnd) {
  RecordLayout layout = recorder().layout();
  layout.samples = 3;
  RecorderSession r(layout, [](std::uint32_t, const SampleRecord&) {});
  r.announce(7);
  addSample(r, 0);
  addSample(r, 1, true);
  EXPECT_TRUE(r.finalSeen());
  EXPECT_FALSE(r.complete());
  r.receiveBase(action(1));
  addSample(r, 2);
  addSample(r, 3, true);
  EXPECT_TRUE(r.complete());
}

TEST_F(RecorderSessionTest, AnOptimizerOwesActionAndReport) {
  RecorderSession r = recorder(true);
  r.announce(7);
  addSample(r, 0);
  addSample(r, 1, true);
  EXPECT_EQ(r.gaps(), (std::vector<std::string>{"sample 0: no control_action",
                                                "sample 0: no solver_report"}));
  EXPECT_EQ(r.gaps(1).size(), 1U);
  r.receiveAction(action(0));
  r.receive(report(0));
  EXPECT_TRUE(r.complete());
}

TEST_F(RecorderSessionTest, WhatComesBeforeTheAnnouncementIsNotLost) {
  RecorderSession r = recorder();
  addSample(r, 0);
  EXPECT_EQ(r.samples(), 0U);
  r.announce(7);
  EXPECT_EQ(r.samples(), 1U);
}

TEST_F(RecorderSessionTest, AnAnnouncedRunStartsOverWhicheverNumberIsLarger) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 0);
  r.receive(measurement(1, true, 1ULL << 63));
  EXPECT_FALSE(r.finalSeen());
  EXPECT_EQ(r.strays(), 1U);
  r.announce(3);
  addSample(r, 1);  // of run 7
  EXPECT_EQ(r.samples(), 0U);
  EXPECT_EQ(r.strays(), 4U);
}

TEST_F(RecorderSessionTest, AForgedFinalDoesNotEndARunThatGoesOn) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 0);
  r.receive(measurement(1, true));
  EXPECT_TRUE(r.finalSeen());
  r.receive(measurement(2));
  EXPECT_FALSE(r.finalSeen());
}

TEST_F(RecorderSessionTest, AStrayStepNumberDoesNotFillTheMemory) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 0);
  r.receive(measurement(4000000000U));
  r.receive(tracking(4000000000U));
  EXPECT_EQ(r.waiting(), 0U);
  EXPECT_EQ(r.strays(), 2U);
  addSample(r, 1);
  EXPECT_EQ(r.samples(), 2U);
}

TEST_F(RecorderSessionTest, RepeatedStraysFarAheadLeaveNoHolesOnTheDisk) {
  RecorderSession r = recorder();
  r.announce(7);
  for (std::uint32_t k = 0; k < 50; ++k) {
    addSample(r, k);
    for (int times = 0; times < 3; ++times) r.receive(measurement(4000000U + k));
  }
  EXPECT_EQ(passed_.size(), 50U);
  EXPECT_EQ(r.gapCount(), 0U);
  EXPECT_EQ(r.strays(), 150U);
}

TEST_F(RecorderSessionTest, ARecorderThatWasAwayForLongGoesOn) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 0);
  const std::uint32_t later = 3 * RecorderSession::kWindow;
  for (std::uint32_t k = later; k < later + 20; ++k) addSample(r, k);
  EXPECT_EQ(r.latest().step, later + 19);
  EXPECT_GT(r.gapCount(), RecorderSession::kWindow);
}

Event event(EventCode code, const std::string& text, std::uint32_t step) {
  return eventOf({code, text.c_str()}, step);
}

TEST_F(RecorderSessionTest, EventsOfControllerAndPlantBelongToTheirSamples) {
  RecorderSession r = recorder(false, true);
  r.announce(7);
  for (const bool plant_first : {true, false}) {
    const std::uint32_t step = plant_first ? 0 : 1;
    const std::vector<Event> of_plant{event(EventCode::kInputClamped, "clamped", step)};
    const std::vector<Event> of_controller{event(EventCode::kLawFailed, "held", step)};
    if (plant_first) r.receive(state(step), of_plant);
    r.receive(tracking(step), of_controller);
    if (!plant_first) r.receive(state(step), of_plant);
    r.receive(measurement(step));
    r.receiveBase(action(step));
  }
  RunRecord record;
  record.samples = passed_;
  EXPECT_EQ(test::shown(test::eventsOf(record)),
            (std::vector<std::string>{"law_failed  0..1 (2)", "input_clamped  0..1 (2)"}));
}

TEST_F(RecorderSessionTest, OfTooManyEventsThoseAreKeptThatAJournalHolds) {
  RecorderSession r = recorder();
  r.announce(7);
  std::vector<Event> many;
  for (const char letter : {'a', 'b', 'c'})
    many.push_back(event(EventCode::kNote, std::string(200, letter), 0));
  r.receive(tracking(0), many);
  r.receive(measurement(0));
  r.receiveBase(action(0));
  ASSERT_EQ(passed_.size(), 1U);
  EXPECT_EQ(passed_[0].events.size(), 2U);
}

TEST_F(RecorderSessionTest, MemoryIsBoundedAndTheOldestThatLacksSomethingIsGivenUpAndNamed) {
  RecorderSession r = recorder();
  r.announce(7);
  for (std::uint32_t k = 0; k <= RecorderSession::kWindow; ++k) {  // no tracking ever
    r.receive(measurement(k));
    r.receiveBase(action(k));
  }
  EXPECT_EQ(r.gapCount(), 1U);
  EXPECT_EQ(r.gaps(1), (std::vector<std::string>{"sample 0: no tracking"}));
  EXPECT_EQ(steps_, (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(r.waiting(), RecorderSession::kWindow);
}

TEST_F(RecorderSessionTest, OneThatLacksSomethingHoldsUpNobodyAndIsAmended) {
  RecorderSession r = recorder();
  r.announce(7);
  r.receive(measurement(0));  // its tracking comes late
  r.receiveBase(action(0));
  addSample(r, 1);
  addSample(r, 2);
  EXPECT_EQ(steps_, (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(r.waiting(), 1U);
  r.receive(tracking(0));
  ASSERT_EQ(steps_, (std::vector<std::uint32_t>{1, 2, 0}));
  EXPECT_TRUE(passed_[2].has_tracking && passed_[2].has_measurement);
  addSample(r, 3, true);
  EXPECT_TRUE(r.complete());
}

TEST_F(RecorderSessionTest, WhatThereIsOfASampleIsKeptBeforeItIsWhole) {
  RecorderSession r = recorder();
  r.announce(7);
  r.receive(measurement(0));
  r.receive(measurement(1));
  r.receive(tracking(1));
  r.keep();
  EXPECT_TRUE(steps_.empty()) << "what is on its way may still come";
  r.keep();
  ASSERT_EQ(steps_, (std::vector<std::uint32_t>{0})) << "of the newest more is to come";
  EXPECT_TRUE(passed_[0].has_measurement && !passed_[0].has_tracking);
  r.keep();
  EXPECT_EQ(steps_.size(), 1U) << "nothing new";
  r.receive(tracking(0));
  r.keep();
  EXPECT_EQ(steps_, (std::vector<std::uint32_t>{0, 0}));
  r.receiveBase(action(0));
  EXPECT_EQ(steps_, (std::vector<std::uint32_t>{0, 0, 0}));
  EXPECT_EQ(r.waiting(), 1U);
}

TEST_F(RecorderSessionTest, LacksSomethingWhileItsNewestSamplesDo) {
  RecorderSession r = recorder();
  r.announce(7);
  addSample(r, 0);
  EXPECT_FALSE(r.lacks());
  r.receive(measurement(1));
  EXPECT_FALSE(r.lacks()) << "the newest waits for its answer";
  r.receive(measurement(2));
  EXPECT_TRUE(r.lacks());
  using Gaps = std::vector<std::pair<std::uint32_t, std::string>>;
  EXPECT_EQ(r.incomplete(0, 2), (Gaps{{1, "tracking"}}));
  addSample(r, 2);
  EXPECT_FALSE(r.lacks()) << "a gap is no reason to be worse for ever";
  EXPECT_EQ(r.incomplete(0, 3), (Gaps{{1, "tracking"}}));
  EXPECT_TRUE(r.incomplete(2, 3).empty());
}

TEST_F(RecorderSessionTest, ClosePassesOnWhatWaits) {
  RecorderSession r = recorder(true);
  r.announce(7);
  addSample(r, 0);
  r.receive(tracking(1));
  r.close();
  ASSERT_EQ(passed_.size(), 1U);
  EXPECT_TRUE(passed_[0].has_base && !passed_[0].has_action);
  EXPECT_FALSE(r.complete());
}

TEST_F(RecorderSessionTest, WrongSizesAreCounted) {
  RecorderSession r = recorder();
  r.announce(7);
  Measurement m = measurement(0);
  m.outputs = Vector::Zero(2);
  r.receive(m);
  EXPECT_EQ(r.wrongSize(), 1U);
  EXPECT_FALSE(r.running());
}

}  // namespace loop_recorder_session_test
}  // namespace fpc
