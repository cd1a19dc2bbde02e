#include "base/step_gate.hpp"

#include <gtest/gtest.h>

namespace fpc {
namespace base_step_gate_test {

StepHeader header(std::uint64_t run, std::uint32_t step) { return {0, run, step}; }

TEST(StepGate, EveryArrivalHasItsName) {
  StepGate gate;
  EXPECT_EQ(gate.pass(header(5, 3)), Arrival::kFirst);
  EXPECT_EQ(gate.pass(header(5, 4)), Arrival::kNext);
  EXPECT_EQ(gate.pass(header(5, 4)), Arrival::kRepeat);
  EXPECT_EQ(gate.pass(header(5, 2)), Arrival::kOld);
  EXPECT_EQ(gate.pass(header(5, 6)), Arrival::kGap);
  EXPECT_EQ(gate.pass(header(4, 7)), Arrival::kOtherRun);
  EXPECT_EQ(gate.pass(header(6, 0)), Arrival::kNewRun);
  EXPECT_EQ(gate.pass(header(6, 1)), Arrival::kNext);
}

TEST(StepGate, EachKindIsCountedApart) {
  StepGate gate;
  for (const auto& h : {header(1, 0), header(1, 0), header(1, 1), header(1, 0), header(1, 5),
                        header(0, 6), header(2, 0)})
    gate.pass(h);
  gate.countWrongSize();
  gate.countNotFinite();
  gate.countNotFinite();
  const ArrivalCounts& counts = gate.counts();
  EXPECT_EQ(counts.accepted, 4U);
  EXPECT_EQ(counts.repeated, 1U);
  EXPECT_EQ(counts.old, 1U);
  EXPECT_EQ(counts.gaps, 1U);
  EXPECT_EQ(counts.other_run, 1U);
  EXPECT_EQ(counts.new_runs, 1U);
  EXPECT_EQ(counts.wrong_size, 1U);
  EXPECT_EQ(counts.not_finite, 2U);
}

TEST(StepGate, DroppedArrivalsAreNotRemembered) {
  StepGate gate;
  EXPECT_TRUE(gate.empty());
  gate.pass(header(3, 10));
  gate.pass(header(3, 4));
  gate.pass(header(2, 11));
  EXPECT_EQ(gate.last().step, 10U);
  EXPECT_EQ(gate.last().run_id, 3U);
  EXPECT_EQ(gate.classify(header(3, 11)), Arrival::kNext);
}

TEST(StepGate, ClassifyingChangesNothing) {
  StepGate gate;
  gate.pass(header(1, 0));
  EXPECT_EQ(gate.classify(header(1, 1)), Arrival::kNext);
  EXPECT_EQ(gate.classify(header(1, 1)), Arrival::kNext);
  EXPECT_EQ(gate.counts().accepted, 1U);
}

TEST(StepGate, OnlyTheAnnouncedRunCountsWhicheverNumberIsLarger) {
  StepGate gate;
  gate.announce(9);
  EXPECT_EQ(gate.pass(header(1ULL << 63, 0)), Arrival::kOtherRun);
  EXPECT_EQ(gate.pass(header(9, 4)), Arrival::kFirst);
  EXPECT_EQ(gate.pass(header(1ULL << 63, 5)), Arrival::kOtherRun);
  EXPECT_EQ(gate.pass(header(9, 5)), Arrival::kNext);
  gate.announce(3);  // the plant came back with an earlier clock
  EXPECT_EQ(gate.pass(header(9, 6)), Arrival::kOtherRun);
  EXPECT_EQ(gate.pass(header(3, 0)), Arrival::kNewRun);
  EXPECT_EQ(gate.pass(header(3, 1)), Arrival::kNext);
}

TEST(StepGate, AStepTooFarAheadIsTakenOnlyWhenItComesAgain) {
  StepGate gate;
  gate.pass(header(1, 5));
  EXPECT_EQ(gate.pass(header(1, 4000000000U)), Arrival::kSuspect);
  EXPECT_EQ(gate.pass(header(1, 6)), Arrival::kNext);
  EXPECT_EQ(gate.pass(header(1, 9000)), Arrival::kSuspect);
  EXPECT_EQ(gate.pass(header(1, 9001)), Arrival::kGap);  // it goes on there
  EXPECT_EQ(gate.counts().suspect, 2U);
}

TEST(StepGate, AfterAStrayJumpThePlantIsFollowedAtOnce) {
  StepGate gate;
  gate.pass(header(1, 5));
  EXPECT_EQ(gate.pass(header(1, 800)), Arrival::kGap);
  EXPECT_EQ(gate.pass(header(1, 6)), Arrival::kResync);
  EXPECT_EQ(gate.pass(header(1, 7)), Arrival::kNext);
  EXPECT_EQ(gate.counts().resyncs, 1U);
}

TEST(StepGate, WhatThePlantKeepsSendingWinsOverARepeatedForgery) {
  for (const std::uint32_t pace : {0U, 1U}) {  // sends again (lockstep), or goes on (realtime)
    StepGate gate;
    gate.pass(header(1, 5));
    for (int i = 0; i < 3; ++i) gate.pass(header(1, 2000000));
    EXPECT_EQ(gate.last().step, 2000000U);
    EXPECT_EQ(gate.pass(header(1, 6)), Arrival::kOld);
    EXPECT_EQ(gate.pass(header(1, 6 + pace)), Arrival::kOld);
    EXPECT_EQ(gate.pass(header(1, 6 + 2 * pace)), Arrival::kResync);
    EXPECT_EQ(gate.pass(header(1, 7 + 2 * pace)), Arrival::kNext);
  }
}

TEST(StepGate, AStrayStepBeforeAllOthersDoesNotKeepTheRunOut) {
  for (const bool second_run : {false, true})
    for (const std::uint32_t stray : {1U, 4000000000U}) {
      StepGate gate;
      if (second_run) gate.pass(header(1, 0));
      gate.announce(2);
      EXPECT_EQ(gate.pass(header(2, stray)), second_run ? Arrival::kNewRun : Arrival::kFirst);
      EXPECT_EQ(gate.pass(header(2, 0)), Arrival::kOld);
      EXPECT_EQ(gate.pass(header(2, 0)), Arrival::kOld);
      EXPECT_EQ(gate.pass(header(2, 0)), Arrival::kResync);
      EXPECT_EQ(gate.pass(header(2, 1)), Arrival::kNext);
    }
}

TEST(StepGate, LateDuplicatesAfterATrueGapAreOld) {
  StepGate gate;
  for (const std::uint32_t step : {5U, 9U, 10U}) gate.pass(header(1, step));
  for (const std::uint32_t step : {3U, 4U, 5U, 5U, 5U, 9U, 6U, 8U})
    EXPECT_EQ(gate.pass(header(1, step)), Arrival::kOld) << step;
  EXPECT_EQ(gate.pass(header(1, 11)), Arrival::kNext);
}

TEST(StepGate, OnlyLostOrNewRunsNeedAReset) {
  for (const auto arrival : {Arrival::kFirst, Arrival::kGap, Arrival::kNewRun, Arrival::kResync})
    EXPECT_TRUE(needsReset(arrival) && isNew(arrival));
  EXPECT_TRUE(isNew(Arrival::kNext) && !needsReset(Arrival::kNext));
  for (const auto arrival :
       {Arrival::kRepeat, Arrival::kOld, Arrival::kSuspect, Arrival::kOtherRun})
    EXPECT_FALSE(isNew(arrival) || needsReset(arrival));
}

}  // namespace base_step_gate_test
}  // namespace fpc
